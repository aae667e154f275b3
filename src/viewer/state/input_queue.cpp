#include "viewer/state/input_queue.h"

namespace tyndall {
void InputQueue::next_frame() {
    std::set<int> changed_buttons, changed_keys;
    bool moved = false;
    for (; !waiting.empty(); waiting.pop_front()) {
        const InputEvent& event = waiting.front();
        if (event.kind == InputEvent::Kind::move) {
            if (!changed_buttons.empty() || !changed_keys.empty()) return;
            mouse = event.at, moved = true;
            continue;
        }
        const bool button = event.kind == InputEvent::Kind::button;
        if ((button && moved) || !(button ? changed_buttons : changed_keys).insert(event.code).second) return;
        std::set<int>& held = button ? buttons : keys;
        if (event.down)
            held.insert(event.code);
        else
            held.erase(event.code);
    }
}
}
