// Ways to make a picture, by each mode: from the quickest to the most careful.
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
}
