// What an earlier tyndall stress has found, taken back from its stress.json.
#pragma once
#include "measuring/stress_report.h"

#include <filesystem>

namespace tyndall {
struct EarlierStress {
    Json report; // null: there is none of this version
};

// Of a file that need not be there; one of another version counts as none. Throws Error (unreadable, refused).
EarlierStress earlier_stress(const std::filesystem::path& file);

// The results of a case, for all of the modes that take part; empty where one is not there or was of other values.
std::vector<StressResult> kept_results(const EarlierStress& earlier, const StressCase& stress,
                                       std::span<const Mode> modes);
}
