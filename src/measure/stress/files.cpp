// Grids as stored in files: bad voxels, tiles, a background, nothing at all.
#include "measure/stress/volumes.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/phase.h"

#include "base/random.h"
#include "volume/medium.h"
#include "volume/vdb/fog.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall {
namespace {
// A grid as read from a file in which a share of the voxels has bad values, and the same grid with those empty.
struct BadGrid {
    SparseVolume mended, emptied;
    bool counted = false;
};
BadGrid bad_grid(double share, std::initializer_list<float> values) {
    BadGrid bad;
    bad.emptied = unit_volume(16, [](vec3 p) { return blob(p); });
    DecodedTree tree;
    tree.leaves = bad.emptied.leaves;
    tree.active.assign(tree.leaves.size(), VoxelMask{});
    uint64_t count = 0;
    for (size_t l = 0; l < tree.leaves.size(); ++l) {
        tree.active[l].fill(~uint64_t{0});
        for (uint32_t v = 0; v < 512; ++v) {
            if (random_unit(static_cast<uint32_t>(l), v, 0, 5) >= static_cast<float>(share)) continue;
            tree.leaves[l].values[v] = values.begin()[count++ % values.size()];
            bad.emptied.leaves[l].values[v] = 0;
        }
    }
    VdbReadReport report;
    make_fog(std::move(tree), bad.mended, report, "a grid");
    bad.mended.index_to_world = bad.emptied.index_to_world;
    bad.counted = report.non_finite + report.negative == count;
    return bad;
}

StressScene not_finite(double share) {
    return looking_at(medium_of(bad_grid(share, {NAN, INFINITY, -INFINITY}).mended, 3));
}
StressScene below_zero(double share) { return looking_at(medium_of(bad_grid(share, {-1, -1e30f, -1e-30f}).mended, 3)); }

double mend_off(Trial& trial) {
    const BadGrid bad = bad_grid(trial.value, {-1});
    const double off = difference(trial.render(), trial.render(looking_at(medium_of(bad.emptied, 3))));
    return bad.counted ? off : infinity;
}

StressScene tiled(double side) {
    const int n = static_cast<int>(side);
    SparseVolume volume = unit_volume(8, [](vec3) { return 0.5f; });
    volume.index_to_world = glm::scale(dmat4(1), dvec3(1.0 / n));
    volume.leaves.clear();
    volume.tiles = {{ivec3(0), ivec3(n - 1), 0.5f}}, volume.active_high = ivec3(n - 1);
    return looking_at(medium_of(volume, 2));
}
double tiles_off(Trial& trial) {
    SparseVolume dense = unit_volume(static_cast<int>(trial.value), [](vec3) { return 0.5f; });
    dense.index_to_world[3] = glm::dvec4(0, 0, 0, 1);
    return difference(trial.render(), trial.render(looking_at(medium_of(dense, 2))));
}

// Two leaves in opposite corners. Between them the density is that of the background; outside there is none.
bool in_corner(ivec3 origin) { return origin == ivec3(0) || origin == ivec3(8); }
StressScene with_background(double density) {
    const SparseVolume dense = unit_volume(16, [](vec3 p) { return blob(p); });
    DecodedTree tree;
    tree.background = static_cast<float>(density), tree.root_nodes = {ivec3(0)};
    for (const Leaf& leaf : dense.leaves)
        if (in_corner(leaf.origin))
            tree.leaves.push_back(leaf), tree.active.emplace_back().fill(~uint64_t{0});
        else
            tree.inactive_tiles.push_back({leaf.origin, leaf.origin + 7, tree.background});
    SparseVolume volume;
    VdbReadReport report;
    make_fog(std::move(tree), volume, report, "a grid");
    volume.index_to_world = dense.index_to_world;
    return looking_at(medium_of(volume, 3));
}
double background_off(Trial& trial) {
    SparseVolume dense = unit_volume(16, [](vec3 p) { return blob(p); });
    for (Leaf& leaf : dense.leaves)
        if (!in_corner(leaf.origin)) std::ranges::fill(leaf.values, static_cast<float>(trial.value));
    return difference(trial.render(), trial.render(looking_at(medium_of(dense, 3))));
}

StressScene nothing(double n) {
    SparseVolume volume = unit_volume(8, [](vec3) { return 0.0f; });
    if (n == 0) volume.leaves.clear(), volume.active_high = ivec3(-1);
    Medium medium = medium_of(volume, 2);
    return looking_at(medium);
}
double anything(Trial& trial) {
    const Layers layers = trial.render();
    double most = max_of(layers.inscatter);
    for (const float share : layers.transmittance.pixels) most = std::max(most, std::abs(1.0 - share));
    return most;
}
}

std::vector<StressCase> stress_files() {
    constexpr std::string_view group = "grids";
    return {
        StressCase("bad-voxels", group, "NaN and infinity in a grid count as empty", "share", "", {0.001, 0.1, 0.9},
                   seen_modes, {}, not_finite, {0, "difference from empty voxels", mend_off}),
        StressCase("negative-voxels", group, "negative density in a grid counts as empty", "share", "",
                   {0.001, 0.1, 0.9}, seen_modes, {}, below_zero, {0, "difference from empty voxels", mend_off}),
        StressCase("tiles", group, "a grid of one tile renders like one of many voxels", "side", "voxels", {8, 32, 64},
                   seen_modes, {}, tiled, {1e-5, "relative RMSE against voxels", tiles_off}),
        StressCase("grid-background", group, "a grid whose background is fog: inside it counts, outside it ends",
                   "density", "", {0.1, 1, 10}, seen_modes, {}, with_background,
                   {1e-5, "relative RMSE against voxels", background_off}),
        StressCase("empty-grid", group, "a grid of zeros, and of nothing", "voxels", "", {512, 0}, Claim::along_rays,
                   {}, nothing, {0, "most light scattered or absorbed", anything}),
    };
}
}
