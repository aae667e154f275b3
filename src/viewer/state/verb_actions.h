// Tables of the verbs and the functions that apply them to the state, one file for each topic.
#pragma once
#include "viewer/state/view_state.h"

#include <span>

namespace tyndall {
struct VerbAction {
    Verb verb;
    void (*apply)(ViewState&, const Action&);
};

std::span<const VerbAction> technique_actions(); // and settings
std::span<const VerbAction> look_actions();      // how an image is shown, what is explained about it, panels
std::span<const VerbAction> camera_actions();
std::span<const VerbAction> time_actions();
std::span<const VerbAction> scene_actions(); // opening, editing, saving, closing

inline bool is_on(const Action& action) { return action.words[0] == "on"; }
}
