// Results of an earlier tyndall stress, read back from its stress.json.
#pragma once
#include "measuring/stress_report.h"

#include <filesystem>

namespace tyndall {
struct EarlierStress {
    Json report; // null: no report of this version
};

// Reads a file, which may be missing; a report of another version counts as none. Throws Error (unreadable, refused).
EarlierStress earlier_stress(const std::filesystem::path& file);

// The results of a case for all of the modes that take part; empty when one is missing or was swept over other values.
std::vector<StressResult> kept_results(const EarlierStress& earlier, const StressCase& stress,
                                       std::span<const Mode> modes);
}
