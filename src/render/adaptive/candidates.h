// Ways for a mode to integrate the fog, from coarse to fine, and the truth they are held against.
#pragma once
#include "modes/settings.h"

#include <span>

namespace tyndall {
struct Mode;

struct Candidate {
    std::string name; // of its rung, without samples
    Settings settings;
};

// At least six rungs for every mode. What decides how carefully a rung works is its own, pixel.samples among it;
// everything else is as in `settings`.
std::vector<Candidate> ladder_of(const Mode& mode, const Settings& settings);

// The rows that the rungs of a mode decide, but for pixel.samples.
std::vector<std::string> ladder_rows(const Mode& mode);

// Copies rows by name.
void take_rows(std::span<const std::string> names, const Settings& from, Settings& to);

// Candidates of a mode, cheapest first, made from a job's settings: what decides how finely fog is integrated is the
// candidate's, except for rows in which the settings depart from their quality; everything else stays. A mode whose
// error is noise has one, the settings as they are; a mode that is a look has none.
std::vector<Candidate> candidates_of(const Mode& mode, const Settings& settings, Quality quality);

// Whether settings keep candidates from something they would decide: getting finer may then not help.
bool binds_candidates(const Mode& mode, const Settings& settings, Quality quality);

// The settings at which the march counts as free of error, for the same light.
Settings truth_of(const Settings& settings);

// Whether a picture of the mode can be rendered to an error asked for: looks cannot.
bool error_can_be_told(const Mode& mode);

// Whether the error has a part that no number of samples removes.
bool has_integrator(const Mode& mode);
}
