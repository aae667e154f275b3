// The editable properties of a scene: one table of the values of lights, media, cameras and the scene itself, for
// panels, scripts and saving. Values are in the units of scene files (meters, degrees, candela, lux).
#pragma once
#include "scene/keyed.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tyndall {
struct Scene;

enum class Part { light, medium, camera, scene };
enum class ValueKind { number, vector, color, toggle }; // number: in x; toggle: x is 0 or 1

// Where a property is stored in a Scene. Angles are in radians there. An unset optional gets its value from elsewhere.
using Slot = std::variant<Keyed<float>*, Keyed<vec3>*, std::optional<Keyed<float>>*, float*, vec3*, bool*>;

struct Property {
    Part part;
    const char* name; // of the scene file's member: "intensity", "background/sky/zenith"
    ValueKind kind;
    const char* unit;              // empty = none
    float min_value, max_value;    // the range of scene files, for each component
    float slider_low, slider_high; // the usual range
    const char* doc;
    Slot (*slot)(Scene& scene, size_t index);
    bool (*applies)(const Scene& scene, size_t index); // whether this light, medium ... has it at present

    // Whether it is a position in the world, which a scene stores relative to its origin.
    bool is_position() const {
        const std::string_view member(name);
        return member == "position" || member == "target" || member == "translate" || member == "base" ||
               member.starts_with("bounds/");
    }
    // Whether a light of the glTF has it from its node.
    bool is_placement() const {
        const std::string_view member(name);
        return part == Part::light && (member == "position" || member == "direction" || member == "up");
    }
    bool is_angle() const { return std::string_view(unit) == "degrees" && kind == ValueKind::number; }
};

std::span<const Property> all_properties();

// The properties of a light, medium or camera, or of the scene (index 0), that can be edited.
std::vector<const Property*> properties_of(const Scene& scene, Part part, size_t index);

// Throws Error (usage) listing the properties that exist.
const Property& find_property(const Scene& scene, Part part, size_t index, std::string_view name);

size_t count_of(const Scene& scene, Part part);
const std::string& name_of(const Scene& scene, Part part, size_t index); // empty for the scene
std::string part_path(const Scene& scene, Part part, size_t index);      // "lights/lamp", for messages; "scene"

// A light's position relative to the scene's origin, its unit direction and what is up for its profile, gobo or face.
struct LightPlacement {
    vec3 position{0}, direction{0, -1, 0}, up{0, 1, 0};
};
LightPlacement light_placement(const Scene& scene, size_t light, double seconds);

// The value at a time; an unlimited range is infinite.
vec3 value_at(const Scene& scene, const Property& property, size_t index, double seconds);
bool is_keyed(const Scene& scene, const Property& property, size_t index);
}
