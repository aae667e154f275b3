// Where in an animation a value set by hand goes: onto the key that stands at the moment, else onto a new key there.
#pragma once
#include <span>

namespace tyndall {
struct KeyPlace {
    size_t index = 0;   // of the key, or of the one to put a new key before
    bool there = false; // a key stands there
    bool seam = false;  // of a loop: its first and last key are the same moment
    float time = 0;     // of the new key
};

// Keys within a twentieth of a frame are at the moment. A moment outside a loop is brought inside. `times` ascend and
// are at least one.
KeyPlace key_place(std::span<const float> times, bool loop, double seconds, double frame_rate);
}
