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
    {Part::light, "position", {"position", "Where the light stands: x, y up, z, metres."}},
    {Part::light, "direction", {"direction", "The way the light travels; 0 -1 0 is straight down."}},
    {Part::light,
     "target",
     {"target", "The point the light shines at, metres. It goes on doing so when the light is moved."}},
    {Part::light, "color", {"colour", "Tint of the light, linear. It multiplies the intensity."}},
    {Part::light,
     "intensity",
     {"intensity", "How bright the light is: candela for lamps, nits for faces, lux for the sun.", true}},
    {Part::light, "exposure", {"exposure", "Brightens the light by stops: each is twice as bright."}},
    {Part::light,
     "volume_scale",
     {"volume scale", "Makes the light's beam in fog stronger or weaker, surfaces left alone. 1 is as in nature."}},
    {Part::light,
     "surface_scale",
     {"surface scale", "Makes the light on surfaces stronger or weaker, fog left alone. 1 is as in nature."}},
    {Part::light,
     "inner_cone",
     {"inner cone", "From the middle of the beam to where it begins to fade: half an angle."}},
    {Part::light,
     "outer_cone",
     {"outer cone", "From the middle of the beam to where it ends: half an angle, not below the inner cone."}},
    {Part::light, "range", {"range", "The light fades to nothing at this distance.", true}},
    {Part::light, "radius", {"radius", "Of the glowing ball or disc: larger means softer shadows and shafts."}},
    {Part::light, "width", {"width", "Of the glowing rectangle, across its upright side."}},
    {Part::light, "height", {"height", "Of the glowing rectangle, along its upright side."}},
    {Part::light, "two_sided", {"two-sided", "Whether the light's face glows on its back as well."}},
    {Part::light, "visible", {"visible", "Whether the camera sees the light's face."}},
    {Part::light, "angle", {"angle", "Half the width of the sun's disc: larger means softer shadows and shafts."}},
    {Part::light, "shadows", {"shadows", "Whether surfaces block the light: no shafts without."}},

    {Part::medium, "extinction", {"extinction", "How thick the fog is: share of light lost per metre.", true}},
    {Part::medium,
     "albedo",
     {"albedo", "Colour of the fog: share of the light it scatters; what is missing from 1 it absorbs."}},
    {Part::medium,
     "g",
     {"anisotropy g", "Above 0 the fog glows towards the light source, below 0 away from it; 0 is even."}},
    {Part::medium,
     "phase/g",
     {"anisotropy g", "Above 0 the fog glows towards the light source, below 0 away from it; 0 is even."}},
    {Part::medium, "phase/alpha", {"alpha", "More of it sends light both on and back: 0 is Henyey-Greenstein's lobe."}},
    {Part::medium,
     "phase/droplet_diameter",
     {"droplet diameter", "Of water, micrometres: small ones glow wide around a light, large ones close to it."}},
    {Part::medium, "phase/weight", {"weight", "Share of the light that the first of two lobes scatters."}},
    {Part::medium, "emission", {"emission", "Light the fog gives off by itself."}},
    {Part::medium, "base", {"base height", "Height below which the fog has its full density."}},
    {Part::medium, "falloff", {"falloff", "Height over which the density falls to about a third.", true}},
    {Part::medium, "wind", {"wind", "How fast the fog's pattern moves along x, y, z, metres per second."}},
    {Part::medium, "translate", {"translate", "Moves the fog, metres."}},
    {Part::medium, "rotate", {"rotate", "Turns the fog about x, then y, then z, degrees."}},
    {Part::medium, "scale", {"scale", "Makes the fog larger or smaller along its own axes."}},
    {Part::medium, "bounds/low", {"bounds low", "Lower corner of the box that the fog fills, metres."}},
    {Part::medium, "bounds/high", {"bounds high", "Upper corner of the box that the fog fills, metres."}},

    {Part::camera, "position", {"position", "Where the eye is, metres."}},
    {Part::camera, "target", {"target", "The point in the middle of the image, metres."}},
    {Part::camera, "vertical_fov", {"vertical fov", "Angle between lower and upper edge of the image."}},
    {Part::camera,
     "aperture_radius",
     {"aperture radius", "Of the lens, metres: larger means less depth of field. 0 is a pinhole, all is sharp."}},
    {Part::camera,
     "focus_distance",
     {"focus distance", "How far away is what is sharp, metres; the target until a value is set.", true}},

    {Part::scene,
     "exposure",
     {"exposure",
      "Stops by which the scene's images are brightened; light itself stays. Automatic until a value is set."}},
    {Part::scene, "ambient", {"ambient", "Even light from everywhere, which nothing shadows."}},
    {Part::scene, "background/color", {"background", "Light behind everything."}},
    {Part::scene, "background/sky/zenith", {"sky zenith", "Colour of the sky straight up."}},
    {Part::scene, "background/sky/horizon", {"sky horizon", "Colour of the sky at the horizon."}},
    {Part::scene, "background/sky/ground", {"sky ground", "Colour straight down."}},
    {Part::scene, "background/intensity", {"background", "Brightness of the image behind everything."}},
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
    if (value > property.slider_high) range.high = std::min(2 * value, property.most);
    if (value < property.slider_low) range.low = value < 0 ? std::max(2 * value, property.least) : property.least;
    return range;
}

// Names that are one ordinary word stay as they are.
std::string in_words(Part part, std::string message) {
    for (const Row& row : rows) {
        if (row.part != part || row.name.find('_') == row.name.npos) continue;
        for (size_t at = 0; (at = message.find(row.name, at)) != message.npos;
             at += std::string_view(row.words.label).size())
            message.replace(at, row.name.size(), row.words.label);
    }
    return message;
}

SunPlace sun_place(vec3 direction) {
    const vec3 to_sun = -glm::normalize(direction);
    const float bearing = glm::degrees(std::atan2(to_sun.x, to_sun.z));
    return {glm::degrees(std::asin(std::clamp(to_sun.y, -1.0f, 1.0f))), bearing < 0 ? bearing + 360 : bearing};
}

vec3 direction_from(const SunPlace& place) {
    const float height = glm::radians(place.height), bearing = glm::radians(place.bearing);
    return -vec3(std::cos(height) * std::sin(bearing), std::sin(height), std::cos(height) * std::cos(bearing));
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
