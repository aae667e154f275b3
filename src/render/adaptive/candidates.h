// Candidates: ways for a mode to integrate the fog, from coarse to fine, and the ground truth they are measured
// against.
#pragma once
#include "modes/settings.h"

#include <span>

namespace tyndall {
struct Mode;

struct Candidate {
    std::string name; // of its rung, without pixel.samples
    Settings settings;
};

// A mode's quality ladder: at least six rungs for every mode. A rung sets the rows that control accuracy, including
// pixel.samples; everything else is as in `settings`.
std::vector<Candidate> ladder_of(const Mode& mode, const Settings& settings);

// The rows that a mode's rungs set, except pixel.samples.
std::vector<std::string> ladder_rows(const Mode& mode);

// Copies rows by name.
void take_rows(std::span<const std::string> names, const Settings& from, Settings& to);

// Candidates of a mode, cheapest first, based on a job's settings: each sets the rows that control how finely fog is
// integrated, except those in which the settings differ from their quality's defaults. A mode whose only error is noise
// has one candidate, the settings unchanged; an artistic mode has none.
std::vector<Candidate> candidates_of(const Mode& mode, const Settings& settings, Quality quality);

// Whether the settings override rows that candidates would set; a finer candidate may then be no more accurate.
bool overrides_candidates(const Mode& mode, const Settings& settings, Quality quality);

// Settings at which the main mode counts as ground truth, for the same light.
Settings truth_settings(const Settings& settings);

// Whether the mode can render to a target error: artistic modes cannot.
bool has_error_bound(const Mode& mode);

// Whether the mode has an integration error (bias) that no number of samples removes.
bool has_integrator(const Mode& mode);
}
