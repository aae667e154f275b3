// User input since the interface's last frame, in order. A slow frame gets only as much at once as it can distinguish:
// the mouse moves, or a button is pressed where it moved to, and so on.
#pragma once
#include "base/math.h"

#include <deque>
#include <set>

namespace tyndall {
struct InputEvent {
    enum class Kind { move, button, key } kind = Kind::move;
    vec2 at{0};        // move: pixels of the window
    int code = 0;      // of the button or key
    bool down = false; // or released
};

struct InputQueue {
    std::deque<InputEvent> waiting;
    vec2 mouse{0}; // the state that the frame sees
    std::set<int> buttons, keys;

    void add(const InputEvent& event) { waiting.push_back(event); }

    // Takes what the next frame sees: moves up to the first change of a button, or changes of different buttons and
    // keys up to the next move. So a drag starts where the button was pressed, and a key that was tapped is down for
    // one frame.
    void next_frame();
};
}
