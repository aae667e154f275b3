// The functions behind the rows of the mode table: one pair per technique, each in its own .cpp.
#pragma once
#include "modes/mode.h"

namespace tyndall {
std::vector<Limit> march_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_march(const View&, const Snapshot&, const Settings&, History*);

std::vector<Limit> cone_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_cone(const View&, const Snapshot&, const Settings&, History*);

std::vector<Limit> billboard_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_billboard(const View&, const Snapshot&, const Settings&, History*);

std::vector<Limit> path_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_path(const View&, const Snapshot&, const Settings&, History*);
}
