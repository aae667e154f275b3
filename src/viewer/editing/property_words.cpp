#include "viewer/editing/property_words.h"

#include "base/error.h"
#include "scene/scene.h"

#include <algorithm>

namespace tyndall {
namespace {
struct Row {
    Part part;
    std::string_view name;
    PropertyWords words;
};

const Row rows[] = {
    {Part::light, "position", {"position", "Position of the light: x, y up, z, meters."}},
    {Part::light, "direction", {"direction", "Direction in which the light travels; 0 -1 0 is straight down."}},
    {Part::light, "up", {"up", "Up direction of the profile, gobo or rectangle: turns it about the aim."}},
    {Part::light,
     "target",
     {"target", "The point the light is aimed at, meters. It stays aimed there when the light is moved."}},
    {Part::light, "color", {"color", "Tint of the light, linear. It multiplies the intensity."}},
    {Part::light,
     "intensity",
     {"intensity",
      "Brightness of the light: candela for points and spots, nits for area lights, lux for the sun, unless another "
      "unit is given.",
      true}},
    {Part::light, "exposure", {"exposure", "Brightens the light by stops: each doubles it."}},
    {Part::light,
     "volume_scale",
     {"volume scale", "Multiplies the light in fog, but not on surfaces. 1 is physically correct."}},
    {Part::light,
     "surface_scale",
     {"surface scale", "Multiplies the light on surfaces, but not in fog. 1 is physically correct."}},
    {Part::light, "inner_cone", {"inner cone", "Half angle of the beam: from its axis to where it begins to fade."}},
    {Part::light,
     "outer_cone",
     {"outer cone", "Half angle of the beam: from its axis to where it ends; not below the inner cone."}},
    {Part::light, "range", {"range", "The light fades to nothing at this distance.", true}},
    {Part::light,
     "radius",
     {"radius", "Radius of the emitting sphere or disc: larger means softer shadows and shafts."}},
    {Part::light, "width", {"width", "Width of the emitting rectangle, across its up direction."}},
    {Part::light, "height", {"height", "Height of the emitting rectangle, along its up direction."}},
    {Part::light, "two_sided", {"two-sided", "Whether the light emits from its back as well."}},
    {Part::light, "visible", {"visible", "Whether the camera sees the light's face."}},
    {Part::light, "angle", {"angle", "Angular radius of the sun's disc: larger means softer shadows and shafts."}},
    {Part::light, "shadows", {"shadows", "Whether surfaces block the light; without shadows there are no shafts."}},

    {Part::medium, "extinction", {"extinction", "Extinction coefficient at density 1, 1/m.", true}},
    {Part::medium,
     "albedo",
     {"albedo", "Color of the fog: the fraction of the extinction that is scattering; the rest is absorption."}},
    {Part::medium, "g", {"anisotropy g", "Above 0 the fog scatters light forward, below 0 backward; 0 is isotropic."}},
    {Part::medium,
     "phase/g",
     {"anisotropy g", "Above 0 the fog scatters light forward, below 0 backward; 0 is isotropic."}},
    {Part::medium,
     "phase/alpha",
     {"alpha", "Larger values scatter more light both forward and backward; 0 is Henyey-Greenstein."}},
    {Part::medium,
     "phase/droplet_diameter",
     {"droplet diameter", "Diameter of the water droplets, micrometers: small ones make a wide glow around a light, "
                          "large ones a narrow one."}},
    {Part::medium, "phase/weight", {"weight", "Fraction of the light that the first of two lobes scatters."}},
    {Part::medium, "emission", {"emission", "Light that the fog itself emits."}},
    {Part::medium, "base", {"base height", "Height below which the fog has its full density."}},
    {Part::medium, "falloff", {"falloff", "Height over which the density falls to 1/e, about 37 %.", true}},
    {Part::medium, "wind", {"wind", "Velocity of the fog's pattern along x, y, z, meters per second."}},
    {Part::medium, "translate", {"translate", "Moves the fog, meters."}},
    {Part::medium, "rotate", {"rotate", "Rotates the fog about x, then y, then z, degrees."}},
    {Part::medium, "scale", {"scale", "Scales the fog along its own axes."}},
    {Part::medium, "bounds/low", {"bounds low", "Lower corner of the box that the fog fills, meters."}},
    {Part::medium, "bounds/high", {"bounds high", "Upper corner of the box that the fog fills, meters."}},

    {Part::camera, "position", {"position", "Position of the camera, meters."}},
    {Part::camera, "target", {"target", "The point in the middle of the image, meters."}},
    {Part::camera,
     "vertical_fov",
     {"vertical fov", "Vertical field of view: the angle between the lower and upper edges of the image."}},
    {Part::camera,
     "aperture_radius",
     {"aperture radius",
      "Radius of the lens aperture, meters: larger means less depth of field. 0 is a pinhole: everything is sharp."}},
    {Part::camera,
     "focus_distance",
     {"focus distance", "Distance at which the image is sharp, meters; that of the target until a value is set.",
      true}},

    {Part::scene,
     "exposure",
     {"exposure",
      "Stops by which displayed images are brightened; EXR files do not change. Automatic until a value is set."}},
    {Part::scene, "ambient", {"ambient", "Uniform light from all directions, without shadows."}},
    {Part::scene, "background/color", {"background", "Color of the background."}},
    {Part::scene, "background/sky/zenith", {"sky zenith", "Color of the sky straight up."}},
    {Part::scene, "background/sky/horizon", {"sky horizon", "Color of the sky at the horizon."}},
    {Part::scene, "background/sky/ground", {"sky ground", "Color straight down."}},
    {Part::scene, "background/intensity", {"background", "Multiplies the background image."}},
};
}

const PropertyWords& words_of(const Property& property) {
    for (const Row& row : rows)
        if (row.part == property.part && row.name == property.name) return row.words;
    fail(ExitCode::internal, property.name, "has no words");
}

SliderRange slider_range(const Property& property, float value) {
    SliderRange range{property.slider_low, property.slider_high, words_of(property).logarithmic};
    if (!std::isfinite(value)) return range;
    if (value > property.slider_high) range.high = std::min(2 * value, property.max_value);
    if (value < property.slider_low)
        range.low = value < 0 ? std::max(2 * value, property.min_value) : property.min_value;
    return range;
}

// Names that are one ordinary word stay as they are.
std::string with_labels(Part part, std::string message) {
    for (const Row& row : rows) {
        if (row.part != part || row.name.find('_') == row.name.npos) continue;
        for (size_t at = 0; (at = message.find(row.name, at)) != message.npos;
             at += std::string_view(row.words.label).size())
            message.replace(at, row.name.size(), row.words.label);
    }
    return message;
}

SunAngles sun_angles(vec3 direction) {
    const vec3 to_sun = -glm::normalize(direction);
    const float azimuth = glm::degrees(std::atan2(to_sun.x, to_sun.z));
    return {glm::degrees(std::asin(std::clamp(to_sun.y, -1.0f, 1.0f))), azimuth < 0 ? azimuth + 360 : azimuth};
}

vec3 direction_from(const SunAngles& angles) {
    const float height = glm::radians(angles.height), azimuth = glm::radians(angles.azimuth);
    return -vec3(std::cos(height) * std::sin(azimuth), std::sin(height), std::cos(height) * std::cos(azimuth));
}

const char* kind_name(const MediumSource& medium) {
    switch (medium.kind) {
    case MediumKind::homogeneous:
        return "homogeneous fog";
    case MediumKind::height:
        return "height fog";
    case MediumKind::noise:
        return "noise fog";
    case MediumKind::vdb:
        break;
    }
    return "volume";
}
}
