// Where an edited value goes in an animation: into the key at that time, or else into a new key.
#pragma once
#include <span>

namespace tyndall {
struct KeyLookup {
    size_t index = 0;    // of the key, or of the key before which a new one is inserted
    bool exists = false; // a key exists at that time
    bool seam = false;   // of a loop: its first and last key are the same time
    float time = 0;      // of the new key
};

// Keys within a twentieth of a frame count as being at the time. A time outside a loop is wrapped into it. `times`
// ascend and are not empty.
KeyLookup find_key(std::span<const float> times, bool loop, double seconds, double frame_rate);
}
