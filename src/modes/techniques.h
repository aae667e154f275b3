// The functions behind the rows of the mode table: one pair per technique, each in its own .cpp.
#pragma once
#include "modes/mode.h"

namespace tyndall {
std::vector<Limit> march_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_march(const View&, const Snapshot&, const Settings&, History*);

std::vector<Limit> froxel_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_froxel(const View&, const Snapshot&, const Settings&, History*);
std::vector<Limit> cone_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_cone(const View&, const Snapshot&, const Settings&, History*);

std::vector<Limit> billboard_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_billboard(const View&, const Snapshot&, const Settings&, History*);

std::vector<Limit> path_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_path(const View&, const Snapshot&, const Settings&, History*);

std::vector<Limit> radial_blur_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_radial_blur(const View&, const Snapshot&, const Settings&, History*);
PostFunction post_radial_blur(const View&, const Snapshot&, const Settings&);
std::vector<Limit> shadow_volume_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_shadow_volume(const View&, const Snapshot&, const Settings&, History*);
std::vector<Limit> shadow_map_limits(const View&, const Snapshot&, const Settings&);
ScatterFunction prepare_shadow_map(const View&, const Snapshot&, const Settings&, History*);
}
