// Intensity and its directional distribution for lights of a scene file: units, IES profiles, gobos.
#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"
#include "scene/file/scene_file.h"
#include "scene/photometry/ies_file.h"
#include "scene/photometry/ies_profile.h"

namespace tyndall {
namespace {
// The unit that a name of the file means for a kind of light.
LightUnit unit_named(const Field& unit, const LightSource& light) {
    const std::string& name = unit.json->string;
    const LightTraits& kind = traits_of(light.kind);
    if (name == "watt") return LightUnit::watt;
    if (name == kind.unit) return LightUnit::native;
    if (name == "candela" && kind.area) return LightUnit::candela;
    if (name != "lumen" || kind.distant)
        refuse(unit, "does not apply to a " + std::string(kind.noun) + "; its intensity is in " +
                         std::string(kind.unit) +
                         (kind.distant ? " or watt"
                          : kind.area  ? ", candela, lumen or watt"
                                       : ", lumen or watt"));
    return LightUnit::lumen;
}

void read_unit(const Field& field, LightSource& light) {
    const Field unit = field.member("unit"), efficacy = field.member("efficacy"), spread = field.member("spread");
    const Field intensity = field.member("intensity");
    if (unit && !intensity) refuse(unit, "has no effect without an intensity");
    if (intensity) light.unit = unit ? unit_named(unit, light) : LightUnit::native;
    const bool watts = intensity && light.unit == LightUnit::watt;
    if (watts && !efficacy)
        refuse(unit, "needs an efficacy in lumens per watt: about 15 for an incandescent lamp, 100 for an LED, 683 "
                     "for Blender's watts");
    if (efficacy && !watts) refuse(efficacy, "is for an intensity in watts only");
    if (efficacy) light.efficacy = read_number(efficacy);
    if (!spread) return;
    if (!has_cone(light))
        refuse(spread, "is for spots only; this light is a " + std::string(traits_of(light.kind).noun));
    if (light.unit == LightUnit::native || light.profile)
        refuse(spread, "applies only to an intensity in lumens or watts without a profile");
    light.whole_sphere = spread.json->string == "sphere";
}
}

void read_light_power(const Field& field, LightSource& light) {
    if (const Field intensity = field.member("intensity")) light.intensity = keyed_number(intensity);
    read_unit(field, light);
    if (const Field exposure = field.member("exposure")) light.exposure = keyed_number(exposure);
    if (const Field temperature = field.member("temperature")) light.temperature = keyed_number(temperature);
    if (const Field up = field.member("up")) {
        if (!light.profile && !light.gobo && light.kind != LightKind::rectangle)
            refuse(up, "is for rectangles and lights with a profile or a gobo only");
        if (light.node >= 0)
            refuse(up, "is taken from the light's glTF node; give the light a position and a direction to set its own");
        light.up = keyed_vector(up);
    }
}

std::shared_ptr<const IesProfile> read_profile(std::string_view bytes, std::string_view where, Scene& scene) {
    const IesFile file = read_ies(bytes, where);
    for (const std::string& note : file.notes) warn(scene, std::string(where) + ": " + note);
    auto profile = make_ies_profile(file, content_hash(bytes));
    if (!profile->loss.empty()) warn(scene, std::string(where) + ": " + profile->loss);
    return profile;
}

void read_profile(const Field& field, Scene& scene, LightSource& light) {
    const Field ies = field.member("ies");
    if (!ies) return;
    const Field file = ies.member("file"), multiplier = ies.member("multiplier");
    const std::filesystem::path path = named_file(file, scene);
    std::string bytes;
    with_location(file, [&] { bytes = read_file(path, largest_ies_file); });
    add_input(scene, path, bytes);
    light.profile = read_profile(bytes, path.string(), scene);
    if (const Field rotate = ies.member("rotate")) light.profile_rotation = keyed_degrees(rotate);
    if (multiplier && field.member("intensity"))
        refuse(multiplier, "cannot be combined with intensity: either the file or the scene sets the brightness");
    light.unit = LightUnit::profile, light.intensity = 1.0f;
    if (multiplier) light.intensity = keyed_number(multiplier);
}

void read_gobo(const Field& field, Scene& scene, LightSource& light) {
    const Field gobo = field.member("gobo");
    if (!gobo) return;
    const Field image = gobo.member("image");
    GoboSource source;
    source.space = gobo.json->string_or("color_space", "srgb") == "linear" ? ColorSpace::linear : ColorSpace::srgb;
    if (const Field rotate = gobo.member("rotate")) source.rotation = keyed_degrees(rotate);
    if (const Field scale = gobo.member("scale")) source.scale = keyed_number(scale);
    with_location(image, [&] { source.sequence = find_sequence(image.json->string, scene.file.parent_path()); });
    const Field sequence = gobo.member("sequence");
    if (!source.sequence.files.empty()) {
        source.sequence.mode = sequence_mode_named(sequence ? sequence.json->string_or("mode", "hold") : "hold");
        source.sequence.offset = sequence ? static_cast<int>(sequence.json->number_or("offset", 0)) : 0;
        light.gobo = source;
        return;
    }
    if (sequence) refuse(sequence, "is for numbered images only (gobo.####.png)");
    const std::filesystem::path path = source.sequence.pattern;
    std::string bytes, note;
    with_location(image, [&] { bytes = read_file(path, largest_gobo_file); });
    add_input(scene, path, bytes);
    source.still = make_gobo(bytes, source.space, image.location(), note);
    if (!note.empty()) warn(scene, image.location() + ": " + note);
    light.gobo = source;
}
}
