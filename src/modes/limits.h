// Limits that several modes share.
#pragma once
#include "modes/mode.h"

namespace tyndall {
// Where a medium is so thick that light scattered more than once shows, and ambient light that nothing shadows.
void add_single_scattering_limits(const Snapshot& snapshot, std::vector<Limit>& limits);

// What a grid of light that has been scattered before cannot show; ambient light too.
void add_fluence_limits(const Snapshot& snapshot, const FluenceSettings& settings, std::vector<Limit>& limits);
}
