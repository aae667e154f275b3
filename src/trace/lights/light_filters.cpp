#include "trace/lights/light_filters.h"

#include "base/error.h"
#include "base/io/file.h"
#include "scene/input_files.h"
#include "scene/light.h"
#include "scene/lights/area_shape.h"
#include "scene/lights/gobo.h"
#include "scene/lights/light_filter.h"
#include "scene/photometry/ies_profile.h"
#include "scene/scene.h"
#include "trace/snapshot.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
// The gobo of a frame; shared with the previous frame if the file is the same.
std::shared_ptr<const Gobo> gobo_of(const GoboSource& source, int frame, MissingFrame missing, const Snapshot* previous,
                                    std::vector<std::string>& notes) {
    if (source.still) return source.still;
    const std::filesystem::path file = gobo_file(source, frame, missing);
    const uint64_t size = check_readable(file);
    const auto changed = std::filesystem::last_write_time(file).time_since_epoch().count();
    const std::string key = file.string() + " " + std::to_string(size) + " " + std::to_string(changed);
    if (previous)
        for (const Light& light : previous->lights)
            for (const auto& known :
                 {light.filter ? light.filter->gobo : nullptr, light.area ? light.area->texture : nullptr})
                if (known && known->file == key) return known;
    std::string note;
    auto gobo = make_gobo(read_file(file, largest_gobo_file), source.space, file.string(), note);
    gobo->file = key;
    if (!note.empty()) note = file.filename().string() + ": " + note;
    if (!note.empty() && !std::ranges::count(notes, note)) notes.push_back(std::move(note));
    return gobo;
}
}

void add_filter(const LightSource& source, Moment moment, vec3 up, MissingFrame missing, const Snapshot* previous,
                std::vector<std::string>& notes, Light& light) {
    if (!source.profile && !source.gobo) return;
    auto filter = std::make_shared<LightFilter>();
    filter->direction = light.direction;
    filter->profile = source.profile;
    filter->profile_axes = light_axes(light.direction, up, source.profile_rotation.at(moment.seconds));
    if (source.gobo) {
        const GoboSource& gobo = *source.gobo;
        filter->gobo = gobo_of(gobo, moment.frame, missing, previous, notes);
        filter->gobo_axes = light_axes(light.direction, up, gobo.rotation.at(moment.seconds));
        const float widest = glm::radians(89.0f);
        const float half = std::tan(std::min(light.outer_cone, widest)) * gobo.scale.at(moment.seconds);
        filter->gobo_half = std::max(half, 1e-6f) * vec2(1, filter->gobo->aspect);
    }
    light.filter = std::move(filter);
    if (light.kind == LightKind::point && source.profile && source.profile->reach <= 0.5f * pi)
        light.kind = LightKind::spot, light.inner_cone = light.outer_cone = source.profile->reach;
}
}
