// The stress suite: the known ways in which fog techniques fail, as tiny scenes with one condition swept from mild to
// hard, rendered by every mode that claims to handle it. A mode may hold, or report beforehand that it will not; it
// must not fail silently.
#pragma once
#include "base/math.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
class LimitationKind;
struct Limitation;
struct Mode;
struct StressScene;
struct Trial; // both in measure/stress/trial.h

// How an error is measured, and how large it may be.
struct StressMeasure {
    double allowed = -1; // below 0: what the mode may have at preview
    std::string_view criterion = "relative RMSE of image or fog light against the exact march";
    double (*error)(Trial& trial) = nullptr; // null = by the criterion above
    double exact = -1;                       // allowed to modes that are exact here
    std::string_view exact_modes{};          // names separated by spaces
    double allowed_bias = infinity;          // of the mean fog light, relative
};

// A limitation that may excuse an error. `wrong` excuses any. `degraded` says that the image is coarse, not that it is
// wrong: it excuses three times the allowed error or `up_to`, whichever is larger; with `amount`, that instead.
struct Excuse {
    const LimitationKind* kind;
    double up_to = 0;
    double (*amount)(const Limitation&) = nullptr; // the error that the limitation states
};

// What modes claim in their table. All but `all`, `along_rays`, `history` and `fluence` imply a physical mode.
enum class Claim : uint16_t {
    all = 0,
    along_rays = 1,
    physical = 2,
    noise_free = 4,
    density = 8,
    shadows = 16,
    lamps = 32,
    history = 64,
    fluence = 128,
    adaptive = 256
};

// The modes that a case is for: those that make all these claims, or one by its name. Empty: the case tests a part of
// the program that all modes share.
struct Participants {
    std::optional<uint16_t> claims{};
    std::string_view name{};

    constexpr Participants() = default;
    constexpr Participants(Claim claim) : claims(static_cast<uint16_t>(claim)) {}
    constexpr Participants(const char* one) : name(one) {}
    bool program() const { return !claims && name.empty(); }
};
constexpr Participants operator|(Claim a, Claim b) {
    return static_cast<Claim>(static_cast<uint16_t>(a) | static_cast<uint16_t>(b));
}

struct StressCase {
    std::string_view id, group, title; // title: what is tested
    std::string_view sweep, unit;      // the condition that is swept
    std::vector<double> values;        // from mild to hard
    Participants modes;
    std::vector<Excuse> excuses; // empty: every mode has to hold throughout
    StressScene (*scene)(double value) = nullptr;
    StressMeasure measure{};
};

// All cases, group by group.
const std::vector<StressCase>& stress_cases();

// Whether the mode takes part in the case.
bool takes_part(const StressCase& stress, const Mode& mode);

enum class Verdict { holds, degrades, fails };

struct StressPoint {
    double value = 0;
    double error = 0, allowed = 0;
    double bias = -1, allowed_bias = infinity; // of the mean fog light, relative; below 0: not measured
    double measured = -1;                      // relative RMSE if `wrong`; else -1
    bool wrong = false;                        // a limitation has severity wrong
    std::string warning;                       // the limitation that excuses most, as a line; empty = none
    double excused_up_to = -1;                 // the largest error that is excused; below 0: none
    uint64_t non_finite = 0, negative = 0; // dropped samples and non-finite values; values below 0, or shares above 1;
                                           // those of the ground truth included

    bool said() const { return excused_up_to >= 0; }
    bool clean() const { return non_finite == 0 && negative == 0; }
    bool holds() const { return clean() && error <= allowed && bias <= allowed_bias; }
    bool silent() const { return !clean() || (!holds() && !(error <= excused_up_to)); }
};

// One mode in one case.
struct StressResult {
    const StressCase* stress = nullptr;
    std::string mode; // "program" when all modes share what is tested
    std::vector<StressPoint> points;
    double seconds = 0;

    Verdict verdict() const;
    const StressPoint* first() const; // the point that decides the verdict; null when it holds
};

// Runs a case with those of the modes that take part, or once for a case of the whole program. Throws Error (internal)
// when cancelled.
std::vector<StressResult> run_stress(const StressCase& stress, std::span<const Mode> modes,
                                     std::atomic<bool>* cancel = nullptr);

// How many points have a limitation of severity wrong, and at how many of them (idle) the error is below 5 %.
struct WrongWarnings {
    int count = 0, idle = 0;
};
WrongWarnings wrong_warnings(std::span<const StressResult> results);

std::string_view name_of(Verdict verdict);
}
