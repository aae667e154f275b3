// The settings at which a mode is held against others: from the quickest picture to the most careful one.
#pragma once
#include "render/candidates.h"

namespace tyndall {
// At least six rungs for every mode. What decides how carefully a rung works is its own, pixel.samples among it;
// everything else is as in `settings`.
std::vector<Candidate> ladder_of(const Mode& mode, const Settings& settings);
}
