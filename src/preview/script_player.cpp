#include "preview/script_player.h"

#include <cstdlib>

namespace tyndall {
namespace {
bool is_over(const Action& wait, const ScriptFacts& facts, double since) {
    if (wait.words[0] == "idle") return facts.idle;
    if (wait.words[0] == "job") return !facts.job;
    if (wait.words[0] == "samples") return facts.samples >= wait.numbers[0];
    return facts.now - since >= std::strtod(wait.words[0].c_str(), nullptr);
}
}

std::optional<Action> next_action(ScriptPlayer& player, const ViewState& state, const ScriptFacts& facts) {
    if (player.finished() || facts.busy || state.loading || (state.playing && state.frames_to_play > 0)) return {};
    const Action& action = player.actions[player.next];
    const bool is_job = action.verb == Verb::render || action.verb == Verb::bake;
    if (is_job && facts.job) return {}; // one after the other
    if (action.verb == Verb::wait) {
        if (player.waiting_since < 0) player.waiting_since = facts.now;
        if (!is_over(action, facts, player.waiting_since)) return {};
    }
    player.waiting_since = -1;
    ++player.next;
    return action;
}
}
