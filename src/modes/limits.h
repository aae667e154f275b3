// Limits that all modes of single scattering share.
#pragma once
#include "modes/mode.h"

namespace tyndall {
// Where a medium is so thick that light scattered more than once shows, and ambient light that nothing shadows.
void add_single_scattering_limits(const Snapshot& snapshot, std::vector<Limit>& limits);
}
