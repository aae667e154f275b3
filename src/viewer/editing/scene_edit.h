// A change of one property of a scene, made in memory.
//
// A constant value is replaced. An animated value is set at the edit's time: the key there is changed, or a key is
// inserted; the other keys stay. The first and last key of a loop are the same time: the first is set, and the last
// with it if both were equal. An edit detaches a light from its glTF node: moving it fixes its direction as well, and
// is refused if the node is animated. A light with a target keeps aiming at it when it moves; the ground of a sky
// follows the horizon until it has its own color.
#pragma once
#include "viewer/editing/properties.h"

namespace tyndall {
struct Edit {
    Part part = Part::light;
    size_t index = 0; // of the light, medium, camera
    std::string property;
    vec3 value{0}; // as in Property: a number in x, degrees
    double seconds = 0;
};

// Applies an edit and returns the edits of single properties that it consists of, in order. Throws Error (usage: there
// is no such property; refused: the value is out of range or inconsistent with others) and then changes nothing.
std::vector<Edit> apply(Scene& scene, const Edit& edit);

// Repeats an edit that apply() returned, on the state it was made on, without checks.
void reapply(Scene& scene, const Edit& edit);

// A part of the scene that can be edited.
struct PartRef {
    Part part = Part::light;
    size_t index = 0;
    bool operator==(const PartRef&) const = default;
};

// "lights/lamp", "media/0", "scene". Throws Error (usage).
PartRef parse_part(const Scene& scene, std::string_view path);

// "lights/lamp/intensity", "media/0/g", "exposure" and "400", "0.9 0.8 0.7", "on". Parts are given by name or by index
// from 0, with a # before an index that is also a name; in names, ~1 stands for a slash and ~0 for ~. One number for a
// vector or color sets all three. Throws Error (usage).
Edit parse_edit(const Scene& scene, std::string_view path, std::string_view value, double seconds);
}
