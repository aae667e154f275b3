// Reads numbers, vectors, colors and their keys from a scene file. The schema has already checked types and ranges.
#pragma once
#include "base/json/json.h"
#include "scene/keyed.h"

#include <string>

namespace tyndall {
// A JSON value with its location, for messages.
struct Field {
    const Json* json = nullptr;
    std::string file, pointer; // "scenes/a.json", "/lights/0"

    explicit operator bool() const { return json != nullptr; }
    std::string location() const;             // "scenes/a.json: /lights/0"
    Field member(std::string_view key) const; // empty when absent
    Field item(size_t index) const;
};

// Throws Error (refused) naming the field.
[[noreturn]] void refuse(const Field& field, std::string_view what);

float read_number(const Field& field);
vec3 read_vector(const Field& field);    // [x, y, z]
dvec3 read_position(const Field& field); // of [x, y, z], or of the first key
vec3 read_color(const Field& field);     // [r, g, b], or one number for all three
inline float read_degrees(const Field& field) { return glm::radians(read_number(field)); }

Keyed<float> keyed_number(const Field& field);
Keyed<float> keyed_degrees(const Field& field);               // to radians
Keyed<float> keyed_height(const Field& field, double origin); // relative to an origin
Keyed<vec3> keyed_vector(const Field& field);
Keyed<vec3> keyed_position(const Field& field, dvec3 origin); // likewise
Keyed<vec3> keyed_color(const Field& field);

// From degrees about X, then Y, then Z. Rotations between keys are split into small steps, so that turns of more than
// 180 degrees stay as written.
Keyed<quat> rotation_of(const Keyed<vec3>& degrees);

// a - b at all times: exact if both have the same keys and interpolation or are both linear, else in short linear
// segments. Throws Error when both loop with different periods; `field` is what the message names.
Keyed<vec3> difference(const Keyed<vec3>& a, const Keyed<vec3>& b, const Field& field);
}
