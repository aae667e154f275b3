#include "scene/file/scene_words.h"

#include "base/error.h"
#include "base/json/json.h"
#include "scene/file/medium_words.h"
#include "scene/file/stand_ins.h"
#include "volume/vdb/vdb.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

namespace tyndall {
std::string list_text(vec3 value) {
    return "[" + json_number(value.x) + ", " + json_number(value.y) + ", " + json_number(value.z) + "]";
}

std::string camera_text(const CameraSource& camera) {
    return "{ \"name\": " + quote_json(camera.name) + ", \"position\": " + list_text(camera.position.at(0)) +
           ", \"target\": " + list_text(camera.target.at(0)) +
           ", \"vertical_fov\": " + json_number(std::round(glm::degrees(camera.vertical_fov.at(0)))) +
           ", \"near\": " + json_number(camera.near) + " }";
}

std::string sun_text(const LightSource& sun) {
    return "{ \"name\": " + quote_json(sun.name) +
           ", \"type\": \"sun\", \"direction\": " + list_text(sun.direction.at(0)) +
           ", \"intensity\": " + json_number(sun.intensity.at(0)) + " }";
}

std::string volume_scene_text(const std::filesystem::path& vdb) {
    const VdbInfo info = vdb_info(vdb);
    const VdbGridInfo* fog = nullptr;
    for (const VdbGridInfo& grid : info.grids)
        if (grid.is_fog) fog = &grid;
    if (!fog && info.grids.size() == 1)
        refuse(vdb.string(), "grid \"" + printable(info.grids[0].name, 80) + "\" " + info.grids[0].why_not);
    if (!fog) refuse(vdb.string(), "cannot tell which grid is the density; name one as \"grid\" in a scene file");

    // The default camera and lights for a box of the volume's bounds.
    const Box voxels{vec3(fog->active_low) - 0.5f, vec3(fog->active_high) + 0.5f};
    Scene stand_in;
    stand_in.media.emplace_back().bounds = transform(mat4(fog->index_to_world), voxels);
    add_missing_camera(stand_in);
    add_missing_light_and_fog(stand_in);

    // If the file states no extinction, 2 % of the light passes along the longest path at maximum density.
    std::string optics;
    if (!states_extinction(info) && fog->maximum > 0)
        optics = ", \"extinction\": " + json_number(default_extinction(*fog));
    return "{\n  \"tyndall\": 1,\n  \"camera\": " + camera_text(stand_in.cameras[0]) + ",\n  \"lights\": [\n    " +
           sun_text(stand_in.lights[0]) + "\n  ],\n  \"ambient\": " + json_number(stand_in.ambient.at(0).x) +
           ",\n  \"media\": [\n    { \"name\": " + quote_json(vdb.stem().string()) +
           ", \"type\": \"vdb\", \"file\": " + quote_json(vdb.filename().string()) + optics + " }\n  ]\n}\n";
}
}
