// Dispatches actions to the tables of the verbs.
#include "viewer/state/verb_actions.h"

#include <map>

namespace tyndall {
namespace {
std::map<Verb, void (*)(ViewState&, const Action&)> all_actions() {
    std::map<Verb, void (*)(ViewState&, const Action&)> all;
    for (const auto& table : {technique_actions(), look_actions(), camera_actions(), time_actions(), scene_actions()})
        for (const VerbAction& one : table) all.emplace(one.verb, one.apply);
    return all;
}
}

bool apply(ViewState& state, const Action& action) {
    static const auto all = all_actions();
    const auto found = all.find(action.verb);
    if (found == all.end()) return false;
    found->second(state, action);
    return true;
}
}
