// What hands did since the last frame of the interface, in its order. A slow frame sees no more of it at once than it
// can tell apart: the mouse goes somewhere, or a button is pressed where it went, and so on.
#pragma once
#include "base/math.h"

#include <deque>
#include <set>

namespace tyndall {
struct InputEvent {
    enum class Kind { move, button, key } kind = Kind::move;
    vec2 at{0};        // move: pixels of the window
    int code = 0;      // of the button or key
    bool down = false; // or let go
};

struct InputQueue {
    std::deque<InputEvent> waiting;
    vec2 mouse{0}; // as the frame sees them
    std::set<int> buttons, keys;

    void add(const InputEvent& event) { waiting.push_back(event); }

    // What the next frame sees: moves up to the first change of a button, or changes of different buttons and keys up
    // to the next move. So a drag counts from where it was pressed, and a key that was tapped is down for one frame.
    void next_frame();
};
}
