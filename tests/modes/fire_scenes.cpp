#include "modes/fire_scenes.h"

#include "modes/path/path_rays.h"
#include "support/run_mode.h"
#include "volume/fog_fixtures.h"
#include "volume/vdb/vdb.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace tyndall::test {
SparseVolume tenth_volume(ivec3 size, const std::function<float(ivec3)>& value) {
    SparseVolume volume = volume_of(ivec3(0), size - 1, [&](int x, int y, int z) { return value(ivec3(x, y, z)); });
    volume.index_to_world = glm::scale(dmat4(1), dvec3(0.1));
    return volume;
}

FileSequence grid_file(const TempFolder& scratch, const std::string& name, SparseVolume volume) {
    FileSequence sequence;
    sequence.pattern = scratch.file(name + ".vdb");
    volume.name = name;
    write_vdb(sequence.pattern, volume, {.half = false});
    return sequence;
}

MediumSource grid_source(const TempFolder& scratch, const std::string& name, const SparseVolume& density,
                         float extinction, vec3 albedo) {
    MediumSource source;
    source.name = name, source.kind = MediumKind::vdb;
    source.sequence = grid_file(scratch, "density", density);
    source.extinction = extinction, source.albedo = albedo;
    return source;
}

GridSource property(const TempFolder& scratch, const std::string& name, const SparseVolume& volume) {
    return {grid_file(scratch, name, volume), {name}, {}};
}

Snapshot snapshot_with(Scene& scene, const MediumSource& medium) {
    scene.media = {medium};
    return make_snapshot(scene, Moment{0, 0});
}

void expect_light(vec3 found, dvec3 expected, double share, const std::string& what) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], share * expected.x) << what << ", channel " << c;
}

void expect_along(const Snapshot& snapshot, const Ray& ray, dvec3 expected, const std::string& what, double share) {
    expect_light(marched(snapshot, settings_for(Quality::preview), ray).radiance, expected, share, what + ", march");
    expect_light(marched(snapshot, exact_settings(), ray).radiance, expected, share, what + ", exact march");
    Settings rays = settings_for(Quality::final);
    rays.march.visibility = Visibility::rays;
    expect_light(marched(snapshot, rays, ray).radiance, expected, share + 1e-3, what + ", march by rays");
    const RayEstimate traced = test::traced(snapshot, ray, 64, 0);
    for (int c = 0; c < 3; ++c) // a false alarm once in 150000 comparisons
        EXPECT_NEAR(traced.value[c], expected[c], 4.5 * traced.error[c] + share * expected.x) << what << ", path";
}
}
