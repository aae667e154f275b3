#include "viewer/editing/scene_edit.h"

#include "base/error.h"
#include "base/text.h"
#include "scene/file/scene_file.h"
#include "viewer/editing/key_place.h"

namespace tyndall {
namespace {
std::string part_path(const Scene& scene, const Edit& edit) {
    return part_path(scene, edit.part, edit.index) + "/" + edit.property;
}

template<class T> void set(Keyed<T>& keyed, T value, const Edit& edit, double frame_rate) {
    if (keyed.times.empty()) {
        keyed = value;
        return;
    }
    const KeyLookup place = find_key(keyed.times, keyed.loop, edit.seconds, frame_rate);
    if (place.seam && keyed.values.back() == keyed.values.front()) keyed.values.back() = value;
    if (!place.exists) {
        keyed.times.insert(keyed.times.begin() + static_cast<std::ptrdiff_t>(place.index), place.time);
        keyed.values.insert(keyed.values.begin() + static_cast<std::ptrdiff_t>(place.index), value);
    }
    keyed.values[place.index] = value;
}

void set(Slot slot, const Property& property, const Edit& edit, double frame_rate) {
    const float number = property.is_angle() ? glm::radians(edit.value.x) : edit.value.x;
    if (auto* keyed = std::get_if<Keyed<float>*>(&slot)) set(**keyed, number, edit, frame_rate);
    if (auto* keyed = std::get_if<Keyed<vec3>*>(&slot)) set(**keyed, edit.value, edit, frame_rate);
    if (auto* maybe = std::get_if<std::optional<Keyed<float>>*>(&slot)) {
        if (!**maybe) **maybe = Keyed<float>(number);
        set(***maybe, number, edit, frame_rate);
    }
    if (auto* value = std::get_if<float*>(&slot)) **value = number;
    if (auto* value = std::get_if<vec3*>(&slot)) **value = edit.value;
    if (auto* value = std::get_if<bool*>(&slot)) **value = edit.value.x != 0;
}

void check_value(const Scene& scene, const Property& property, const Edit& edit) {
    const bool one = property.kind == ValueKind::number || property.kind == ValueKind::toggle;
    for (int i = 0; i < (one ? 1 : 3); ++i)
        if (!(edit.value[i] >= property.min_value && edit.value[i] <= property.max_value))
            refuse(part_path(scene, edit), formatted("%.7g is not between %.7g and %.7g", edit.value[i],
                                                     property.min_value, property.max_value));
    if (!(std::abs(edit.seconds) <= 1e6)) refuse(part_path(scene, edit), "the moment is not within a million seconds");
}

// Updates what depends on the value just set.
void follow(const Scene& scene, LightSource& light, const Edit& edit) {
    if (edit.property == "position" || edit.property == "direction") light.node = -1;
    if (light.target && (edit.property == "position" || edit.property == "target"))
        light.direction =
            difference(*light.target, light.position, {nullptr, scene.file.string(), part_path(scene, edit)});
}

void follow(Background& background, const Edit& edit) {
    if (edit.property == "background/sky/ground") background.own_ground = true;
    if (edit.property == "background/sky/horizon" && !background.own_ground) background.ground = background.color;
}

// Refuses what the reader of scene files refuses.
void check(const LightSource& light, const std::string& place) {
    const auto is_zero = [](vec3 direction) { return glm::dot(direction, direction) == 0; };
    if (is_aimed(light) && std::ranges::any_of(light.direction.values, is_zero))
        refuse(place, "leaves the light without a direction");
    if (has_cone(light) && !cones_fit(light))
        refuse(place, "outer_cone must not be less than inner_cone, at any moment");
}

void check(const MediumSource& medium, const std::string& place) {
    for (const vec3 scale : medium.scale.values)
        if (const char* why = scale_problem(scale)) refuse(place, why);
    if (!glm::all(glm::lessThan(medium.bounds.low, medium.bounds.high)))
        refuse(place, "the lower corner of the bounds must be less than the upper one");
    for (const float g : medium.g.values)
        if (medium.phase.takes_medium_g() && std::abs(g) > traits_of(medium.phase.kind).max_g)
            refuse(place, std::string(traits_of(medium.phase.kind).g_error));
}

void check(const CameraSource& camera, const std::string& place) {
    if (camera.position.constant() && camera.target.constant() && camera.position.values[0] == camera.target.values[0])
        refuse(place, "position and target would be the same point: the camera would have no viewing direction");
}

// Applies a change to one part, and undoes it if it is refused.
template<class T, class Change> void all_or_nothing(T& thing, const Change& change) {
    T before = thing;
    try {
        change();
    } catch (const Error&) {
        thing = std::move(before);
        throw;
    }
}

void change(Scene& scene, const Property& property, const Edit& edit) {
    set(property.slot(scene, edit.index), property, edit, scene.frame_rate);
    if (edit.part == Part::light) follow(scene, scene.lights[edit.index], edit);
    if (edit.part == Part::medium && edit.property == "rotate")
        scene.media[edit.index].rotation = rotation_of(scene.media[edit.index].rotate);
    if (edit.part == Part::scene) follow(scene.background, edit);
    if (edit.part == Part::scene && edit.property == "exposure") scene.own_exposure = true;
}

void apply_single(Scene& scene, const Edit& edit) {
    const Property& property = find_property(scene, edit.part, edit.index, edit.property);
    check_value(scene, property, edit);
    const auto checked = [&](auto& thing) {
        all_or_nothing(thing, [&] {
            change(scene, property, edit);
            check(thing, part_path(scene, edit));
        });
    };
    switch (edit.part) {
    case Part::light:
        return checked(scene.lights[edit.index]);
    case Part::medium:
        return checked(scene.media[edit.index]);
    case Part::camera:
        return checked(scene.cameras[edit.index]);
    case Part::scene:
        change(scene, property, edit);
    }
}

bool is_animated(const Scene& scene, int node) {
    for (; node >= 0; node = scene.nodes[node].parent) {
        const Node& here = scene.nodes[node];
        if (!here.translation.constant() || !here.rotation.constant() || !here.scale.constant()) return true;
    }
    return false;
}

// Detaches a light from its node with all of its placement, as a scene file requires.
std::vector<Edit> detach_edits(const Scene& scene, const Edit& edit) {
    const LightSource& light = scene.lights[edit.index];
    if (is_animated(scene, light.node))
        refuse(part_path(scene, edit),
               "is animated in the glTF (node \"" + scene.nodes[light.node].name + "\"); change it there");
    std::vector<Edit> edits;
    for (const Property* property : properties_of(scene, Part::light, edit.index)) {
        if (!property->is_placement()) continue;
        edits.push_back(edit);
        if (property->name == edit.property) continue;
        edits.back().property = property->name;
        edits.back().value = value_at(scene, *property, edit.index, edit.seconds) + 0.0f;
    }
    return edits;
}
}

std::vector<Edit> apply(Scene& scene, const Edit& edit) {
    if (edit.index >= count_of(scene, edit.part))
        fail(ExitCode::usage, edit.property, "the scene has no such light, medium or camera");
    Edit clean = edit;
    clean.value += 0.0f; // turns -0 into 0: JSON readers do not keep its sign
    const Property& property = find_property(scene, clean.part, clean.index, clean.property);
    check_value(scene, property, clean);
    if (property.is_position() && scene.origin != dvec3(0))
        refuse(part_path(scene, clean),
               "the scene is too far from the world origin to edit positions here; edit the file");
    if (!property.is_placement() || scene.lights[clean.index].node < 0) {
        apply_single(scene, clean);
        return {clean};
    }
    const std::vector<Edit> edits = detach_edits(scene, clean);
    LightSource& light = scene.lights[clean.index];
    all_or_nothing(light, [&] {
        for (const Edit& single : edits) apply_single(scene, single);
    });
    return edits;
}

void reapply(Scene& scene, const Edit& edit) {
    change(scene, find_property(scene, edit.part, edit.index, edit.property), edit);
}
}
