// Plays a script: one action after another, each when the previous one is done.
#pragma once
#include "viewer/state/view_state.h"

namespace tyndall {
// What the script can wait for.
struct ScriptFacts {
    double now = 0;    // clock time in seconds
    bool idle = false; // the requested image is shown and finished
    int samples = 0;   // of the image of the state's revision; 0 while it is not of the requested mode
    bool busy = false; // a drag, a file or a key is in progress
    bool job = false;  // a job that writes files is running
};

struct ScriptPlayer {
    std::vector<Action> actions;
    size_t next = 0;
    double waiting_since = -1; // negative: the next action is not waiting yet

    bool finished() const { return next >= actions.size(); }
};

// The action to do next; empty while the script waits or after it has ended. Handles the verb wait. Throws Error
// (usage) instead of waiting forever.
std::optional<Action> next_action(ScriptPlayer& player, const ViewState& state, const ScriptFacts& facts);
}
