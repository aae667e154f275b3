// What of a scene can be changed while it is looked at: one table of lights', fog's, cameras' and the scene's own
// numbers serves panels, scripts and saving. Values are in the units of scene files (metres, degrees, candela, lux).
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

// Where a property lives in a Scene. Angles are kept in radians there. What is optional is found elsewhere until it is
// set.
using Slot = std::variant<Keyed<float>*, Keyed<vec3>*, std::optional<Keyed<float>>*, float*, vec3*, bool*>;

struct Property {
    Part part;
    const char* name; // of the member of the scene file: "intensity", "background/sky/zenith"
    ValueKind kind;
    const char* unit;              // empty = none
    float least, most;             // what a scene file may hold, every component
    float slider_low, slider_high; // where it is mostly wanted
    const char* doc;
    Slot (*slot)(Scene& scene, size_t index);
    bool (*applies)(const Scene& scene, size_t index); // whether this light, medium … has it now

    // Whether it is a place in the world, which a scene counts from its origin.
    bool is_place() const {
        const std::string_view member(name);
        return member == "position" || member == "target" || member == "translate" || member == "base" ||
               member.starts_with("bounds/");
    }
    bool is_angle() const { return std::string_view(unit) == "degrees" && kind == ValueKind::number; }
};

std::span<const Property> all_properties();

// What can be changed of one light, medium or camera, or of the scene (index 0).
std::vector<const Property*> properties_of(const Scene& scene, Part part, size_t index);

// Throws Error (usage) listing what there is.
const Property& find_property(const Scene& scene, Part part, size_t index, std::string_view name);

size_t count_of(const Scene& scene, Part part);
const std::string& name_of(const Scene& scene, Part part, size_t index); // empty for the scene
std::string place_of(const Scene& scene, Part part, size_t index);       // "lights/lamp", for messages; "scene"

// Where a light is and which way it shines, in the world; direction of unit length, of no meaning for point lights.
struct LightPlace {
    vec3 position{0}, direction{0, -1, 0};
};
LightPlace light_place(const Scene& scene, size_t light, double seconds);

// The value at a moment; a range is infinite where none is given.
vec3 value_at(const Scene& scene, const Property& property, size_t index, double seconds);
bool is_keyed(const Scene& scene, const Property& property, size_t index);
}
