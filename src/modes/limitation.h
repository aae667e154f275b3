// What a technique reports before it renders: where its image will be wrong, why, and by how much. Code decides by kind
// and amounts; the sentence is only for people to read.
#pragma once
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
class Json;

enum class Severity { info, degraded, wrong };

struct Limitation;

// A kind of error: a constant beside the code that detects it. Its sentence has a placeholder per amount, in order: {}
// prints two significant digits, {n} a whole number.
class LimitationKind {
public:
    constexpr LimitationKind(std::string_view name, std::string_view text) : id(name), sentence(text) {}
    LimitationKind(const LimitationKind&) = delete; // compared by address
    const std::string_view id;                      // snake_case, for reports; stays the same when the sentence changes

private:
    friend std::string sentence_of(const Limitation&);
    friend std::span<const double> amounts_of(const Limitation&);
    const std::string_view sentence;
};

// What a limitation is about.
enum class Subject { scene, image, surfaces, camera, light, medium, material, card, setting };

struct Limitation {
    Severity severity = Severity::info;
    const LimitationKind* kind = nullptr;
    Subject subject = Subject::scene;
    std::string name{};              // of the light, the medium, the setting ...; empty where there is only one
    std::array<double, 2> amounts{}; // the numbers in the sentence; the first measures how severe it is

    bool is(const LimitationKind& other) const { return kind == &other; }
    bool operator==(const Limitation&) const = default;
};
using Limitations = std::vector<Limitation>;

// Limitations of the same kind, severity and subject type: "12 lights" rather than twelve lines.
struct LimitationGroup {
    Limitation worst; // the one with the largest amount
    std::vector<std::string> names;

    bool operator==(const LimitationGroup&) const = default;
};
std::vector<LimitationGroup> groups_of(std::span<const Limitation> limitations); // ordered by their first members

// --- text for people and reports, with printable names ---
std::string_view name_of(Severity severity);
std::string where_of(const Limitation& limitation);               // "light sun"
std::string where_of(const LimitationGroup& group);               // "12 lights (key, fill, rim, ...)"
std::string sentence_of(const Limitation& limitation);            // without severity and subject
std::span<const double> amounts_of(const Limitation& limitation); // those that the sentence uses
std::string line_of(const LimitationGroup& group);                // "degraded: light sun: ..."
// An array with one {severity, id, where, names, amounts, why} per group: all names, the amounts of the worst.
Json json_of(const Limitations& limitations);
}
