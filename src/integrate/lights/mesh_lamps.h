// Lamps that approximate emissive surfaces for techniques that support only lamps.
#pragma once
#include "scene/light.h"
#include "trace/snapshot.h"

#include <memory>
#include <vector>

namespace tyndall {
struct StyleSettings;

struct MeshLamps {
    // At most four, or one for each set of casters that links name. Each is at the power-weighted center of some
    // meshes, with their directional intensity (including self-shadowing), and illuminates only fog.
    std::vector<Light> lamps;       // their casters are indices below
    double reach = 0;               // meters; farther from a lamp its error is at most lamps_tolerance
    std::vector<CasterSet> casters; // those of the surfaces that do not emit themselves
};

inline constexpr double lamps_tolerance = 0.1;

// Lamps for the emissive surfaces of a snapshot; null if there are none.
std::shared_ptr<const MeshLamps> mesh_lamps(const Snapshot& snapshot);

// The snapshot with lamps for its emissive surfaces appended to its lights, in the style's tint, if `wanted`.
Snapshot with_mesh_lamps(Snapshot snapshot, const StyleSettings& style, bool wanted);
}
