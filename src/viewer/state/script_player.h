// A script as the window follows it: one action after the other, each when what came before is done.
#pragma once
#include "viewer/state/view_state.h"

namespace tyndall {
// What the script waits for.
struct ScriptFacts {
    double now = 0;    // seconds of a clock
    bool idle = false; // what was asked for is shown, and will not get better
    int samples = 0;   // of the picture of the state's revision; 0 while it is not the mode asked for
    bool busy = false; // a drag, a file or a key is not done yet
    bool job = false;  // one that writes files runs
};

struct ScriptPlayer {
    std::vector<Action> actions;
    size_t next = 0;
    double waiting_since = -1; // negative: the next action has not begun to wait

    bool finished() const { return next >= actions.size(); }
};

// The action to do now; nothing while the script waits or when it has ended. Waiting is done in here. Throws Error
// (usage) instead of waiting for ever.
std::optional<Action> next_action(ScriptPlayer& player, const ViewState& state, const ScriptFacts& facts);
}
