// Lights of a scene file: new ones, and changes to those of the glTF.
#include "base/text.h"
#include "scene/file/scene_file.h"

namespace tyndall {
namespace {

LightKind kind_named(std::string_view name) {
    return static_cast<LightKind>(std::ranges::find(light_kinds, name, &LightTraits::name) - light_kinds);
}

// Refuses fields that do not apply to the light's kind.
void check_fields(const Field& field, const LightSource& light) {
    const LightTraits& kind = traits_of(light.kind);
    const bool aimed = kind.aimed || light.profile || field.member("ies");
    const auto only = [&](const char* name, bool fits, const char* who) {
        if (const Field given = field.member(name); given && !fits)
            refuse(given, "is for " + std::string(who) + " only; this light is a " + std::string(kind.noun));
    };
    only("inner_cone", kind.cone, "spots");
    only("outer_cone", kind.cone, "spots");
    const bool rectangle = light.kind == LightKind::rectangle, lamp = !kind.distant && !kind.area;
    only("direction", aimed, "spots, suns, rectangles, discs and lights with a profile");
    only("target", aimed, "spots, suns, rectangles, discs and lights with a profile");
    only("ies", lamp, "point lights and spots");
    only("gobo", kind.cone || rectangle, "spots and rectangles");
    for (const char* name : {"rotate", "scale"})
        if (const Field gobo = field.member("gobo"); rectangle && gobo && gobo.member(name))
            refuse(gobo.member(name), "is for the gobo of a spot; a rectangle shows its picture from edge to edge");
    only("range", lamp, "point lights and spots");
    only("radius", !kind.distant && !rectangle, "point lights, spots, discs and spheres");
    for (const char* name : {"width", "height"}) only(name, rectangle, "rectangles");
    only("two_sided", kind.area && kind.aimed, "rectangles and discs");
    only("visible", kind.area, "environments, rectangles, discs and spheres");
    only("angle", kind.distant, "suns");
    for (const char* name : {"sky", "image", "rotation"}) only(name, false, "environments");
    if (const Field target = field.member("target"); target && field.member("direction"))
        refuse(target, "cannot be combined with direction");
}

// Position and aim of the light: given here, or left to the node of the glTF.
void read_placement(const Field& field, dvec3 origin, LightSource& light) {
    const Field position = field.member("position"), target = field.member("target");
    const Field direction = field.member("direction");
    if (!position && !target && !direction) {
        if (light.node < 0) refuse(field, "a new light needs a position, a direction or both");
        return;
    }
    const bool aims = target || direction;
    if (!is_distant(light) && !position) refuse(field, "a light that is placed here needs a position");
    if (is_aimed(light) && !aims) refuse(field, "a light that is placed here needs a direction or a target");
    if (is_distant(light) && target && !position)
        refuse(target, "needs a position to aim from; a sun can have a direction instead");
    light.node = -1;
    if (position) light.position = keyed_position(position, origin);
    if (direction) light.direction = keyed_vector(direction);
    light.target.reset();
    if (target) light.target = keyed_position(target, origin);
    if (target) light.direction = difference(*light.target, light.position, target);
    for (const vec3 value : light.direction.values)
        if (glm::dot(value, value) == 0) refuse(target ? target : direction, "leaves the light without a direction");
}

// Fields of area lights.
void read_face(const Field& field, LightSource& light) {
    const auto size = [&](const char* name, Keyed<float>& value) {
        const Field given = field.member(name);
        if (!given) refuse(field, "a " + std::string(traits_of(light.kind).noun) + " needs a " + name);
        value = keyed_number(given);
        for (const float meters : value.values)
            if (!(meters > 0)) refuse(given, "must be greater than 0");
    };
    if (light.kind == LightKind::rectangle)
        size("width", light.width), size("height", light.height);
    else
        size("radius", light.radius);
    light.two_sided = field.json->boolean_or("two_sided", false);
    light.visible = field.json->boolean_or("visible", true);
}

void read_fields(const Field& field, Scene& scene, LightSource& light) {
    const auto number = [&](const char* name, Keyed<float>& value, Keyed<float> (*read)(const Field&)) {
        if (const Field given = field.member(name)) value = read(given);
    };
    if (const Field color = field.member("color")) light.color = keyed_color(color);
    read_profile(field, scene, light), read_gobo(field, scene, light);
    read_light_power(field, light);
    number("volume_scale", light.volume_scale, keyed_number);
    number("surface_scale", light.surface_scale, keyed_number);
    number("inner_cone", light.inner_cone, keyed_degrees);
    number("outer_cone", light.outer_cone, keyed_degrees);
    number("radius", light.radius, keyed_number);
    if (has_area(light)) read_face(field, light);
    number("angle", light.angle, keyed_degrees);
    number("range", light.range, keyed_number);
    light.shadows = field.json->boolean_or("shadows", light.shadows);
    if (const Field link = field.member("light_link")) light.lit = read_link(link, scene);
    if (const Field link = field.member("shadow_link")) light.casters = read_link(link, scene);
    if (has_cone(light) && !cones_fit(light))
        refuse(field.member("outer_cone") ? field.member("outer_cone") : field,
               "outer_cone must not be less than inner_cone, at any moment");
    if (has_cone(light) && std::ranges::max(light.outer_cone.values) <= 0)
        refuse(field.member("outer_cone"), "is 0 at all times: the light has no beam");
    if (has_cone(light) && std::ranges::max(light.outer_cone.values) < 0.999f * narrowest_cone)
        refuse(field.member("outer_cone"), "is below 0.05 degrees, too narrow for single precision");
}

std::vector<std::string> light_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const LightSource& light : scene.lights) names.push_back(light.name);
    return names;
}

LightSource* find(Scene& scene, const std::string& name) {
    for (LightSource& light : scene.lights)
        if (light.name == name) return &light;
    return nullptr;
}

LightSource new_light(const Field& field, const Scene& scene) {
    for (const char* needed : {"type", "intensity"})
        if (!field.member(needed) && !(field.member("ies") && needed == std::string_view("intensity"))) {
            std::string hint;
            if (field.member("name") && !scene.lights.empty())
                hint = " (no light of the glTF has the name \"" + field.json->string_or("name", "") + "\")";
            refuse(field, std::string("a new light needs \"") + needed + "\"" + hint);
        }
    LightSource light;
    light.name = field.json->string_or("name", "light " + std::to_string(scene.lights.size() + 1));
    light.kind = kind_named(field.member("type").json->string);
    return light;
}
}

bool cones_fit(const LightSource& light) {
    const auto fits = [&](float seconds) { return !(light.inner_cone.at(seconds) > light.outer_cone.at(seconds)); };
    return fits(0) && std::ranges::all_of(light.inner_cone.times, fits) &&
           std::ranges::all_of(light.outer_cone.times, fits);
}

void read_lights(const Field& root, Scene& scene) {
    const Field lights = root.member("lights");
    if (!lights) return;
    const size_t of_gltf = scene.lights.size();
    for (size_t i = 0; i < lights.json->items.size(); ++i) {
        const Field field = lights.item(i);
        if (is_environment(field)) continue;
        LightSource* known = field.member("name") ? find(scene, field.json->string_or("name", "")) : nullptr;
        if (known && known >= scene.lights.data() + of_gltf)
            refuse(field.member("name"), "another light already has this name");
        if (known && field.member("type") && kind_named(field.member("type").json->string) != known->kind)
            refuse(field.member("type"), std::string("the light of the glTF is a ") +
                                             std::string(traits_of(known->kind).noun) + "; its type cannot be changed");
        LightSource light = known ? *known : new_light(field, scene);
        if (!known && find(scene, light.name)) refuse(field, "the name \"" + light.name + "\" is taken");
        check_fields(field, light);
        light.entry = field.pointer;
        read_placement(field, scene.origin, light);
        read_fields(field, scene, light);
        if (known)
            *known = light;
        else
            scene.lights.push_back(light);
    }
}

void read_billboards(const Field& root, Scene& scene) {
    const Field billboards = root.member("billboards");
    if (!billboards) return;
    for (size_t i = 0; i < billboards.json->items.size(); ++i) {
        const Field field = billboards.item(i);
        Billboard card;
        card.name = field.json->string_or("name", "billboard " + std::to_string(i + 1));
        card.light = field.member("light").json->string;
        if (!find(scene, card.light))
            refuse(field.member("light"), unknown_name("light", card.light, light_names(scene)));
        card.from = vec3(read_position(field.member("from")) - scene.origin);
        card.to = vec3(read_position(field.member("to")) - scene.origin);
        if (card.from == card.to) refuse(field.member("to"), "is the same point as from");
        if (const Field width = field.member("width_from")) card.width_from = read_number(width);
        if (const Field width = field.member("width_to")) card.width_to = read_number(width);
        if (const Field tint = field.member("tint")) card.tint = read_color(tint);
        if (const Field intensity = field.member("intensity")) card.intensity = read_number(intensity);
        scene.billboards.push_back(card);
    }
}
}
