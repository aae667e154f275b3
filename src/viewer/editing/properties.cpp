#include "viewer/editing/properties.h"

#include "base/error.h"
#include "base/text.h"
#include "scene/scene.h"
#include "volume/phase/mie.h"

#include <algorithm>

namespace tyndall {
namespace {
using enum ValueKind;

bool is_spot(const Scene& scene, size_t i) { return has_cone(scene.lights[i]); }
bool is_sun(const Scene& scene, size_t i) { return is_distant(scene.lights[i]); }
bool is_local(const Scene& scene, size_t i) { return !is_sun(scene, i); }
template<LightUnit unit> bool is_local_in(const Scene& scene, size_t i) {
    return is_local(scene, i) && scene.lights[i].unit == unit;
}
bool is_face(const Scene& scene, size_t i) { return has_area(scene.lights[i]); }
bool is_lamp(const Scene& scene, size_t i) { return is_local(scene, i) && !is_face(scene, i); }
bool is_rectangle(const Scene& scene, size_t i) { return scene.lights[i].kind == LightKind::rectangle; }
bool is_round(const Scene& scene, size_t i) { return is_face(scene, i) && !is_rectangle(scene, i); }
bool has_sides(const Scene& scene, size_t i) { return is_face(scene, i) && is_aimed(scene.lights[i]); }
template<LightUnit unit> bool is_face_in(const Scene& scene, size_t i) {
    return is_face(scene, i) && scene.lights[i].unit == unit;
}
bool is_lamp_in_candela(const Scene& scene, size_t i) {
    return is_lamp(scene, i) && scene.lights[i].unit == LightUnit::native;
}
template<LightUnit unit> bool is_sun_in(const Scene& scene, size_t i) {
    return is_sun(scene, i) && scene.lights[i].unit == unit;
}
bool has_target(const Scene& scene, size_t i) { return scene.lights[i].target.has_value(); }
bool has_place(const Scene& scene, size_t i) { return is_local(scene, i) || has_target(scene, i); }
bool has_direction(const Scene& scene, size_t i) {
    return (is_aimed(scene.lights[i]) || scene.lights[i].profile) && !has_target(scene, i);
}
bool has_up(const Scene& scene, size_t i) {
    return scene.lights[i].profile || scene.lights[i].gobo || is_rectangle(scene, i);
}
bool has_mean_cosine(const Scene& scene, size_t i) { return scene.media[i].phase.takes_medium_g(); }
bool has_phase(const Scene& scene, size_t i, std::initializer_list<PhaseKind> kinds) {
    const PhaseSource& phase = scene.media[i].phase;
    return phase.own_numbers && std::ranges::find(kinds, phase.kind) != kinds.end();
}
bool has_lobe(const Scene& scene, size_t i) {
    return has_phase(scene, i, {PhaseKind::henyey_greenstein, PhaseKind::draine});
}
bool is_draine(const Scene& scene, size_t i) { return has_phase(scene, i, {PhaseKind::draine}); }
bool is_mie(const Scene& scene, size_t i) { return has_phase(scene, i, {PhaseKind::mie}); }
bool is_mix(const Scene& scene, size_t i) { return has_phase(scene, i, {PhaseKind::mix}); }
bool is_height(const Scene& scene, size_t i) { return scene.media[i].kind == MediumKind::height; }
bool is_noise(const Scene& scene, size_t i) { return scene.media[i].recipe.has_value(); }
bool has_bounds(const Scene& scene, size_t i) {
    return is_finite(scene.media[i].bounds.low) && is_finite(scene.media[i].bounds.high);
}
bool is_own_camera(const Scene& scene, size_t i) { return scene.cameras[i].node < 0; }
bool has_view_angle(const Scene& scene, size_t i) {
    return is_own_camera(scene, i) && !is_orthographic(scene.cameras[i]);
}
bool has_lens(const Scene& scene, size_t i) {
    const CameraSource& camera = scene.cameras[i];
    return has_view_angle(scene, i) && (camera.focus || !camera.aperture.constant() || camera.aperture.values[0] > 0);
}
// Whether the file itself states a background of this kind: one that shows the environment's map cannot be edited apart
// from it.
bool is_kind(const Scene& scene, BackgroundKind kind) {
    const Background& back = scene.background;
    const bool shown = scene.environment && !scene.environment->map.stated &&
                       scene.environment->map.kind == back.kind && scene.environment->map.image == back.image;
    return back.kind == kind && !shown;
}
bool is_even(const Scene& scene, size_t) { return is_kind(scene, BackgroundKind::color); }
bool is_sky(const Scene& scene, size_t) { return is_kind(scene, BackgroundKind::sky); }
bool is_image(const Scene& scene, size_t) { return is_kind(scene, BackgroundKind::image); }
bool always(const Scene&, size_t) { return true; }

template<auto member> Slot of_light(Scene& scene, size_t i) { return &(scene.lights[i].*member); }
template<auto member> Slot of_medium(Scene& scene, size_t i) { return &(scene.media[i].*member); }
template<auto member> Slot of_phase(Scene& scene, size_t i) { return &(scene.media[i].phase.*member); }
template<auto member> Slot of_camera(Scene& scene, size_t i) { return &(scene.cameras[i].*member); }

constexpr float far = 1e9f, bright = 1e18f, tiny = 1e-6f;

const Property table[] = {
    // lights
    {Part::light, "position", vector, "m", -far, far, -10, 10, "Where the light is", of_light<&LightSource::position>,
     has_place},
    {Part::light, "direction", vector, "", -far, far, -1, 1, "The way the light travels, any length",
     of_light<&LightSource::direction>, has_direction},
    {Part::light, "up", vector, "", -far, far, -1, 1, "Which way is up in its profile, gobo or face",
     of_light<&LightSource::up>, has_up},
    {Part::light, "target", vector, "m", -far, far, -10, 10, "The point the light shines at",
     [](Scene& s, size_t i) -> Slot { return &*s.lights[i].target; }, has_target},
    {Part::light, "color", color, "", 0, bright, 0, 1, "Color, multiplies the intensity", of_light<&LightSource::color>,
     always},
    {Part::light, "intensity", number, "cd", 0, bright, 0, 2000, "Luminous intensity",
     of_light<&LightSource::intensity>, is_lamp_in_candela},
    {Part::light, "intensity", number, "nt", 0, bright, 0, 10000, "Radiance of the face",
     of_light<&LightSource::intensity>, is_face_in<LightUnit::native>},
    {Part::light, "intensity", number, "cd", 0, bright, 0, 2000, "Luminous intensity along the axis",
     of_light<&LightSource::intensity>, is_face_in<LightUnit::candela>},
    {Part::light, "intensity", number, "lm", 0, bright, 0, 10000, "Luminous flux", of_light<&LightSource::intensity>,
     is_local_in<LightUnit::lumen>},
    {Part::light, "intensity", number, "W", 0, bright, 0, 1000, "Power, times the efficacy",
     of_light<&LightSource::intensity>, is_local_in<LightUnit::watt>},
    {Part::light, "intensity", number, "lx", 0, bright, 0, 100, "Illuminance across the light",
     of_light<&LightSource::intensity>, is_sun_in<LightUnit::native>},
    {Part::light, "intensity", number, "W/m2", 0, bright, 0, 10, "Irradiance, times the efficacy",
     of_light<&LightSource::intensity>, is_sun_in<LightUnit::watt>},
    {Part::light, "exposure", number, "stops", -64, 64, -8, 8, "Brightens the light: times 2 for each",
     of_light<&LightSource::exposure>, always},
    {Part::light, "volume_scale", number, "", 0, bright, 0, 4, "Multiplies the light in fog only",
     of_light<&LightSource::volume_scale>, always},
    {Part::light, "surface_scale", number, "", 0, bright, 0, 4, "Multiplies the light on surfaces only",
     of_light<&LightSource::surface_scale>, always},
    {Part::light, "inner_cone", number, "degrees", 0, 90, 0, 90, "Half angle of the part of full brightness",
     of_light<&LightSource::inner_cone>, is_spot},
    {Part::light, "outer_cone", number, "degrees", 0, 90, 0, 90, "Half angle where the light ends",
     of_light<&LightSource::outer_cone>, is_spot},
    {Part::light, "range", number, "m", tiny, far, 0.1f, 100, "The light fades to nothing at this distance",
     of_light<&LightSource::range>, is_lamp},
    {Part::light, "radius", number, "m", 0, bright, 0, 0.5f, "Radius of the glowing ball: soft shadows",
     of_light<&LightSource::radius>, is_lamp},
    {Part::light, "radius", number, "m", tiny, far, 0.01f, 2, "Radius of the glowing face",
     of_light<&LightSource::radius>, is_round},
    {Part::light, "width", number, "m", tiny, far, 0.01f, 5, "Of the glowing face, across its up",
     of_light<&LightSource::width>, is_rectangle},
    {Part::light, "height", number, "m", tiny, far, 0.01f, 5, "Of the glowing face, along its up",
     of_light<&LightSource::height>, is_rectangle},
    {Part::light, "two_sided", toggle, "", 0, 1, 0, 1, "Whether the face glows on its back, too",
     of_light<&LightSource::two_sided>, has_sides},
    {Part::light, "visible", toggle, "", 0, 1, 0, 1, "Whether the camera sees the face",
     of_light<&LightSource::visible>, is_face},
    {Part::light, "angle", number, "degrees", 0, 90, 0, 5, "Half angle of the sun's disc: soft shadows",
     of_light<&LightSource::angle>, is_sun},
    {Part::light, "shadows", toggle, "", 0, 1, 0, 1, "Whether surfaces block the light",
     of_light<&LightSource::shadows>, always},

    // fog
    {Part::medium, "extinction", number, "1/m", 0, bright, 0, 1, "Density: extinction at density 1",
     of_medium<&MediumSource::extinction>, always},
    {Part::medium, "albedo", color, "", 0, 1, 0, 1, "Share of the extinction that is scattered, not absorbed",
     of_medium<&MediumSource::albedo>, always},
    {Part::medium, "g", number, "", -largest_g, largest_g, -0.9f, 0.9f,
     "Mean cosine of the scattering angle: above 0 forward", of_medium<&MediumSource::g>, has_mean_cosine},
    {Part::medium, "phase/g", number, "", -largest_g, largest_g, -0.9f, 0.9f,
     "Direction of the scattered light: above 0 forward", of_phase<&PhaseSource::g>, has_lobe},
    {Part::medium, "phase/alpha", number, "", 0, bright, 0, 10, "How much light goes both forward and backward",
     of_phase<&PhaseSource::alpha>, is_draine},
    {Part::medium, "phase/droplet_diameter", number, "micrometers", tiny, static_cast<float>(largest_droplet), 5, 50,
     "Diameter of the fog's droplets", of_phase<&PhaseSource::droplet_diameter>, is_mie},
    {Part::medium, "phase/weight", number, "", 0, 1, 0, 1, "Share of the light that the first lobe scatters",
     of_phase<&PhaseSource::weight>, is_mix},
    {Part::medium, "emission", color, "nits/m", 0, bright, 0, 1, "Radiance added per meter at density 1",
     of_medium<&MediumSource::emission>, always},
    {Part::medium, "base", number, "m", -far, far, -10, 10, "World height below which the density is 1",
     of_medium<&MediumSource::height_base>, is_height},
    {Part::medium, "falloff", number, "m", tiny, far, 0.1f, 50, "Meters over which the density falls to 1/e",
     of_medium<&MediumSource::height_falloff>, is_height},
    {Part::medium, "wind", vector, "m/s", -far, far, -2, 2, "Carries the noise",
     [](Scene& s, size_t i) -> Slot { return &s.media[i].recipe->wind; }, is_noise},
    {Part::medium, "translate", vector, "m", -far, far, -10, 10, "Moves the fog", of_medium<&MediumSource::translation>,
     always},
    {Part::medium, "rotate", vector, "degrees", -far, far, -180, 180, "Turns the fog about X, then Y, then Z",
     of_medium<&MediumSource::rotate>, always},
    {Part::medium, "scale", vector, "", -far, far, 0.1f, 10, "Factors along the fog's own axes, not 0",
     of_medium<&MediumSource::scale>, always},
    {Part::medium, "bounds/low", vector, "m", -far, far, -20, 20, "Lower corner of the box the fog fills",
     [](Scene& s, size_t i) -> Slot { return &s.media[i].bounds.low; }, has_bounds},
    {Part::medium, "bounds/high", vector, "m", -far, far, -20, 20, "Upper corner of the box the fog fills",
     [](Scene& s, size_t i) -> Slot { return &s.media[i].bounds.high; }, has_bounds},

    // cameras that are not the glTF's
    {Part::camera, "position", vector, "m", -far, far, -10, 10, "Where the eye is", of_camera<&CameraSource::position>,
     is_own_camera},
    {Part::camera, "target", vector, "m", -far, far, -10, 10, "The point in the middle of the picture",
     of_camera<&CameraSource::target>, is_own_camera},
    {Part::camera, "vertical_fov", number, "degrees", 5, 150, 10, 120, "Angle between lower and upper edge",
     of_camera<&CameraSource::vertical_fov>, has_view_angle},
    {Part::camera, "aperture_radius", number, "m", 0, far, 0, 0.2f, "Radius of the lens: depth of field",
     of_camera<&CameraSource::aperture>, has_view_angle},
    {Part::camera, "focus_distance", number, "m", tiny, far, 0.1f, 50,
     "Distance of what is sharp; that of the target until it is set", of_camera<&CameraSource::focus>, has_lens},

    // the scene itself
    {Part::scene, "exposure", number, "EV", -64, 64, -8, 8,
     "Stops by which PNGs are brightened; automatic until it is set",
     [](Scene& s, size_t) -> Slot { return &s.exposure; }, always},
    {Part::scene, "ambient", color, "nits", 0, bright, 0, 1, "Radiance from everywhere, not shadowed",
     [](Scene& s, size_t) -> Slot { return &s.ambient; }, always},
    {Part::scene, "background/color", color, "nits", 0, bright, 0, 1, "Radiance behind everything",
     [](Scene& s, size_t) -> Slot { return &s.background.color; }, is_even},
    {Part::scene, "background/sky/zenith", color, "nits", 0, bright, 0, 4, "Radiance straight up",
     [](Scene& s, size_t) -> Slot { return &s.background.zenith; }, is_sky},
    {Part::scene, "background/sky/horizon", color, "nits", 0, bright, 0, 4, "Radiance at the horizon",
     [](Scene& s, size_t) -> Slot { return &s.background.color; }, is_sky},
    {Part::scene, "background/sky/ground", color, "nits", 0, bright, 0, 4, "Radiance straight down",
     [](Scene& s, size_t) -> Slot { return &s.background.ground; }, is_sky},
    {Part::scene, "background/intensity", number, "", 0, bright, 0, 4, "Multiplies the image",
     [](Scene& s, size_t) -> Slot { return &s.background.intensity; }, is_image},
};
}

std::span<const Property> all_properties() { return table; }

std::vector<const Property*> properties_of(const Scene& scene, Part part, size_t index) {
    std::vector<const Property*> properties;
    for (const Property& property : table)
        if (property.part == part && property.applies(scene, index)) properties.push_back(&property);
    return properties;
}

const Property& find_property(const Scene& scene, Part part, size_t index, std::string_view name) {
    std::vector<std::string> names;
    for (const Property* property : properties_of(scene, part, index)) {
        if (property->name == name) return *property;
        names.push_back(property->name);
    }
    fail(ExitCode::usage, part_path(scene, part, index),
         names.empty() ? "it belongs to the glTF and cannot be edited here" : unknown_name("property", name, names));
}

size_t count_of(const Scene& scene, Part part) {
    switch (part) {
    case Part::light:
        return scene.lights.size();
    case Part::medium:
        return scene.media.size();
    case Part::camera:
        return scene.cameras.size();
    case Part::scene:
        break;
    }
    return 1;
}

const std::string& name_of(const Scene& scene, Part part, size_t index) {
    static const std::string none;
    switch (part) {
    case Part::light:
        return scene.lights[index].name;
    case Part::medium:
        return scene.media[index].name;
    case Part::camera:
        return scene.cameras[index].name;
    case Part::scene:
        break;
    }
    return none;
}

std::string part_path(const Scene& scene, Part part, size_t index) {
    switch (part) {
    case Part::light:
        return "lights/" + name_of(scene, part, index);
    case Part::medium:
        return "media/" + name_of(scene, part, index);
    case Part::camera:
        return "cameras/" + name_of(scene, part, index);
    case Part::scene:
        break;
    }
    return "scene";
}
}
