// The environment light: an entry among the lights, with its own map or the scene's background.
#include "scene/file/scene_file.h"

namespace tyndall {
namespace {
constexpr std::string_view own_fields[] = {"name",     "type",      "color",      "sky",          "image",
                                           "rotation", "intensity", "exposure",   "volume_scale", "surface_scale",
                                           "shadows",  "visible",   "light_link", "shadow_link"};
constexpr const char* map_fields[] = {"color", "sky", "image"};

void check_fields(const Field& field) {
    for (const auto& [name, value] : field.json->members)
        if (std::ranges::find(own_fields, name) == std::end(own_fields))
            refuse(field.member(name), "does not apply to environment lights");
}

bool has_map(const Field& field) {
    const auto given = [&](const char* name) { return static_cast<bool>(field.member(name)); };
    return std::ranges::any_of(map_fields, given);
}

// Makes a visible environment the background, unless the scene has one.
void show(const Field& field, const EnvironmentSource& environment, Background& background) {
    const Field visible = field.member("visible");
    const bool wanted = !visible || field.json->boolean_or("visible", true);
    if (background.stated) {
        if (visible && wanted) refuse(visible, "the scene has a background, and the camera sees that instead");
        return;
    }
    if (!wanted) return;
    background = environment.map, background.stated = true;
    background.intensity = environment.intensity, background.exposure = environment.exposure;
}

EnvironmentSource read_one(const Field& field, const Scene& scene) {
    EnvironmentSource environment;
    environment.name = field.json->string_or("name", "environment");
    const auto number = [&](const char* name, Keyed<float>& value) {
        if (const Field given = field.member(name)) value = keyed_number(given);
    };
    number("intensity", environment.intensity), number("exposure", environment.exposure);
    number("volume_scale", environment.volume_scale), number("surface_scale", environment.surface_scale);
    environment.shadows = field.json->boolean_or("shadows", true);
    if (const Field link = field.member("light_link")) environment.lit = read_link(link, scene);
    if (const Field link = field.member("shadow_link")) environment.casters = read_link(link, scene);
    return environment;
}

// Uses the scene's background as the environment map.
void share_background(const Field& field, const Scene& scene, EnvironmentSource& environment) {
    if (!scene.background.stated)
        refuse(field, "an environment needs a color, a sky or an image, or the scene's background");
    if (scene.background.kind == BackgroundKind::image && !scene.background.lat_long)
        refuse(field, "the background is a plate; it lights the scene only with the projection \"lat_long\"");
    for (const char* name : {"visible", "rotation"})
        if (const Field given = field.member(name))
            refuse(given, "is for environments with their own color, sky or image; this one uses the background");
    environment.map = scene.background;
}
}

bool is_environment(const Field& light) { return light.json->string_or("type", "") == "environment"; }

void read_environment(const Field& root, Scene& scene) {
    const Field lights = root.member("lights");
    if (!lights) return;
    for (size_t i = 0; i < lights.json->items.size(); ++i) {
        const Field field = lights.item(i);
        if (!is_environment(field)) continue;
        if (scene.environment) refuse(field, "a scene can have only one environment light");
        check_fields(field);
        EnvironmentSource environment = read_one(field, scene);
        if (std::ranges::find(scene.lights, environment.name, &LightSource::name) != scene.lights.end())
            refuse(field.member("name") ? field.member("name") : field, "another light already has this name");
        if (has_map(field)) {
            read_map(field, scene, environment.map);
            if (const Field rotation = field.member("rotation")) {
                if (environment.map.kind != BackgroundKind::image) refuse(rotation, "is for an image only");
                environment.map.rotation = keyed_degrees(rotation);
            }
            show(field, environment, scene.background);
        } else {
            share_background(field, scene, environment);
        }
        scene.environment = std::move(environment);
    }
}
}
