#include "modes/fire_scenes.h"

#include "volume/fog_fixtures.h"
#include "volume/vdb/vdb.h"

#include <glm/gtc/matrix_transform.hpp>

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
}
