// One change of one number of a scene, made in memory at once.
//
// A value without keys is replaced. A value with keys gets the new one at the edit's moment: the key that stands there
// is changed, or a key is put in; the other keys stay. In a loop the first and the last key are one moment: the first
// is set, and the last with it when both were equal. Values on glTF nodes are taken over into the scene: moving such a
// light fixes its direction as well, and is refused while the node is animated. A light that shines at a target goes on
// doing so when it moves; the ground of a sky goes with the horizon until it has a colour of its own.
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

// Changes the scene and returns the edits of single properties that make it up, in order. Throws Error (usage: there is
// no such property; refused: the value is out of range or makes no sense with its neighbours) and then changes nothing.
std::vector<Edit> apply(Scene& scene, const Edit& edit);

// An edit that `apply` returned, made once more on what it was made on: nothing is checked.
void apply_again(Scene& scene, const Edit& edit);

// One of the things that edits change.
struct Thing {
    Part part = Part::light;
    size_t index = 0;
    bool operator==(const Thing&) const = default;
};

// "lights/lamp", "media/0", "scene". Throws Error (usage).
Thing parse_thing(const Scene& scene, std::string_view path);

// "lights/lamp/intensity", "media/0/g", "exposure" and "400", "0.9 0.8 0.7", "on": names or numbers from 0, with a #
// before a number that is a name as well; ~1 stands for a slash in a name, ~0 for ~. One number for a vector or colour
// means all three. Throws Error (usage).
Edit parse_edit(const Scene& scene, std::string_view path, std::string_view value, double seconds);
}
