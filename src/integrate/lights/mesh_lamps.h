// Lamps that stand for glowing surfaces where techniques know of nothing else.
#pragma once
#include "scene/light.h"
#include "trace/snapshot.h"

#include <memory>
#include <vector>

namespace tyndall {
struct MeshLamps {
    // At most four, each in the middle of the power of some meshes, with their candela in every direction (what they
    // shadow of themselves left out). They shine on fog alone.
    std::vector<Light> lamps;
    double reach = 0;  // metres from a lamp: beyond, the light it stands for is off by no more than lamps_tolerance
    CasterSet casters; // what shadows them: all that does not glow
};

inline constexpr double lamps_tolerance = 0.1;

// Of the opaque surfaces of a snapshot that emit; null where there are none.
std::shared_ptr<const MeshLamps> mesh_lamps(const Snapshot& snapshot);

// The snapshot with lamps for its glowing surfaces behind its own lights, if they are `wanted`.
Snapshot with_mesh_lamps(Snapshot snapshot, bool wanted);
}
