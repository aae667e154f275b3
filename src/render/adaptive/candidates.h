// Ways for a mode to integrate the fog, from coarse to fine, and the truth they are held against.
#pragma once
#include "modes/settings.h"
#include "render/adaptive/ladders.h"

namespace tyndall {
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
