// What a picture is made of, term by term, and how wrong it would be without each.
#pragma once
#include "modes/settings.h"

#include <atomic>
#include <functional>

namespace tyndall {
struct Snapshot;
struct View;

// One term of the light, for one light or the whole scene. Errors are E of a picture that leaves it out or takes it
// more simply, everything else right.
struct Term {
    std::string name;    // "shadows", "dimming of light", ...
    std::string where;   // a light by name; empty = the scene
    std::string simpler; // what was tried in its place: "left out", "average", "isotropic", ...
    double error = 0;    // measured; the bound where it was not
    double bound = 0;    // the error is below this: for certain where `rigorous`, else with a confidence of 97.5 %
    bool rigorous = false;
    bool needed = true; // at the error asked for
    std::string why{};  // in words, with numbers
};

struct TermControl {
    std::atomic<bool>* cancel = nullptr;
    std::function<void(double)> progress; // 0..1
};

// Share of the error asked for that leaving out one term may use up.
inline constexpr double term_share = 0.25;

// All terms the scene could need. A term whose bound is known beforehand to be small is not measured.
std::vector<Term> terms_of(const View& view, const Snapshot& snapshot, const Settings& settings, double error,
                           const TermControl& control = {});

// The settings with what is not needed switched off: march.* rows, which other modes follow too.
Settings without_needless(const std::vector<Term>& terms, Settings settings);

// A share as "4.2 %".
std::string percent_text(double share);

// Optical depth that no line through the fog exceeds; infinite where no bound is known.
double thickest_line(const Snapshot& snapshot);
}
