// What a technique says of itself before it renders: where its image will be off, why, and by how much. Decisions are
// made on kinds and numbers; the sentence is made only for people to read.
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

// One way to be off: a constant beside the code that finds it. Its sentence names the amounts in their order: {} with
// two digits, {n} as a whole number.
class LimitationKind {
public:
    constexpr LimitationKind(std::string_view name, std::string_view text) : id(name), sentence(text) {}
    LimitationKind(const LimitationKind&) = delete; // told apart by address
    const std::string_view id;                      // snake_case, in reports: stays when the sentence changes

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
    std::string name{};              // of the light, the medium, the setting ...; empty where there is one only
    std::array<double, 2> amounts{}; // the numbers of the sentence, the one that says how bad it is first

    bool is(const LimitationKind& other) const { return kind == &other; }
    bool operator==(const Limitation&) const = default;
};
using Limitations = std::vector<Limitation>;

// Those of one kind and severity about subjects of one sort: "12 lights" rather than twelve lines.
struct LimitationGroup {
    Limitation worst; // the one with the largest amount
    std::vector<std::string> names;

    bool operator==(const LimitationGroup&) const = default;
};
std::vector<LimitationGroup> groups_of(std::span<const Limitation> limitations); // in the order of their first ones

// --- for people and reports: printable
// --------------------------------------------------------------------------------
std::string_view name_of(Severity severity);
std::string where_of(const Limitation& limitation);               // "light sun"
std::string where_of(const LimitationGroup& group);               // "12 lights (key, fill, rim, ...)"
std::string sentence_of(const Limitation& limitation);            // without severity and where
std::span<const double> amounts_of(const Limitation& limitation); // those that the sentence names
std::string line_of(const LimitationGroup& group);                // "degraded: light sun: ..."
// An array with one {severity, id, where, names, amounts, why} a group: all names, the amounts of the worst.
Json json_of(const Limitations& limitations);
}
