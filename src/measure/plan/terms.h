// The lighting terms of an image, and the error without each.
#pragma once
#include "modes/settings.h"

#include <atomic>
#include <functional>

namespace tyndall {
struct Snapshot;
struct View;

// One lighting term, of one light or the whole scene. Errors are E of an image in which only this term is left out or
// simplified.
struct Term {
    std::string name;    // "shadows", "light-side transmittance", ...
    std::string where;   // a light by name; empty = the scene
    std::string simpler; // what was tried in its place: "left out", "average", "isotropic", ...
    double error = 0;    // measured, or else the bound
    double bound = 0;    // the error is below this: certain if `rigorous`, else with a confidence of 97.5 %
    bool rigorous = false;
    bool needed = true; // at the target error
    std::string why{};  // in words, with numbers
};

struct TermControl {
    std::atomic<bool>* cancel = nullptr;
    std::function<void(double)> progress; // 0..1
};

// Share of the target error that leaving out one term may use up.
inline constexpr double term_share = 0.25;

// All terms the scene could need, for a target error. A term with a small enough a priori bound is not measured.
std::vector<Term> terms_of(const View& view, const Snapshot& snapshot, const Settings& settings, double error,
                           const TermControl& control = {});

// The settings with the terms that are not needed switched off.
Settings drop_unneeded(const std::vector<Term>& terms, Settings settings);

// A share as "4.2 %".
std::string percent_text(double share);

// An upper bound of the optical depth along any line through the fog; infinite where none is known.
double max_optical_depth(const Snapshot& snapshot);
}
