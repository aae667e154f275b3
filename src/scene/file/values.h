// Numbers, vectors, colours and their keys out of a scene file. The schema has checked shapes and ranges.
#pragma once
#include "base/json/json.h"
#include "scene/keyed.h"

#include <string>

namespace tyndall {
// A value and where it stands, so that a message can say so.
struct Field {
    const Json* json = nullptr;
    std::string file, pointer; // "scenes/a.json", "/lights/0"

    explicit operator bool() const { return json != nullptr; }
    std::string place() const;                // "scenes/a.json: /lights/0"
    Field member(std::string_view key) const; // empty when absent
    Field item(size_t index) const;
};

// Throws Error (refused) naming the field.
[[noreturn]] void refuse(const Field& field, std::string_view what);

float read_number(const Field& field);
vec3 read_vector(const Field& field); // [x, y, z]
dvec3 read_place(const Field& field); // of [x, y, z], or of the first key
vec3 read_color(const Field& field);  // [r, g, b], or one number for all three
inline float read_degrees(const Field& field) { return glm::radians(read_number(field)); }

Keyed<float> keyed_number(const Field& field);
Keyed<float> keyed_degrees(const Field& field); // to radians
Keyed<vec3> keyed_vector(const Field& field);
Keyed<vec3> keyed_place(const Field& field, dvec3 origin); // counted from an origin
Keyed<vec3> keyed_color(const Field& field);

// Degrees about X, then Y, then Z. Turns between keys stay as written, however far: they are cut into small steps.
Keyed<quat> rotation_of(const Keyed<vec3>& degrees);

// a - b at every moment: exact where both move alike, else in small straight steps.
// Throws Error when both loop with different periods; `field` is what the message names.
Keyed<vec3> difference(const Keyed<vec3>& a, const Keyed<vec3>& b, const Field& field);
}
