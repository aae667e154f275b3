// What verbs do to the state, by what they are about: one file for each table.
#pragma once
#include "viewer/state/view_state.h"

#include <span>

namespace tyndall {
struct VerbAction {
    Verb verb;
    void (*apply)(ViewState&, const Action&);
};

std::span<const VerbAction> technique_actions(); // and settings
std::span<const VerbAction> look_actions();      // how a picture is shown, what is asked about it, panels
std::span<const VerbAction> camera_actions();
std::span<const VerbAction> time_actions();
std::span<const VerbAction> scene_actions(); // opening, editing, saving, closing

inline bool is_on(const Action& action) { return action.words[0] == "on"; }
}
