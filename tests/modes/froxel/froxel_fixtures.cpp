#include "modes/froxel/froxel_fixtures.h"

#include "modes/froxel/settings.h"
#include "scene/camera.h"
#include "trace/occlusion/occluders.h"
#include "trace/view.h"

namespace tyndall::test {
TestScene half_shadowed_fog() {
    return make_scene({homogeneous_medium(0.3f, {vec3(-3, 0, -3), vec3(3, 3, 3)})}, {sun_light({0.3f, -1, 0.1f}, 2)},
                      {quad({-50, 4, -50}, {50.2f, 0, 0}, {0, 0, 100})});
}

Settings as_wide(Settings settings, ivec2 size) {
    int& tile = settings.of<FroxelSettings>().tile;
    const int pixels = tile;
    while (with_tile(settings.of<FroxelSettings>(), size).tile < pixels) ++tile;
    return settings;
}

ScatterFunction froxels(const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
    return find_mode("froxel").prepare(view, snapshot, settings, history);
}

}
