#include "viewer/state/script_player.h"

#include "base/error.h"
#include "base/text.h"

#include <cstdlib>

namespace tyndall {
namespace {
bool is_over(const Action& wait, const ScriptFacts& facts, double since) {
    if (wait.words[0] == "idle") return facts.idle;
    if (wait.words[0] == "job") return !facts.job;
    if (wait.words[0] == "samples") return facts.samples >= wait.numbers[0];
    return facts.now - since >= std::strtod(wait.words[0].c_str(), nullptr);
}

// Refuses waits that would never end.
void check_end(const Action& wait, const ViewState& state) {
    const std::string& what = wait.words[0];
    if (what == "samples" && wait.numbers[0] > state.max_samples)
        fail(ExitCode::usage, "wait samples",
             formatted("an image is finished after %d samples; use --samples for more", state.max_samples));
    if ((what == "idle" || what == "samples") && state.playing)
        fail(ExitCode::usage, "wait " + what, "playback does not end: use play N, or stop");
}
}

std::optional<Action> next_action(ScriptPlayer& player, const ViewState& state, const ScriptFacts& facts) {
    if (player.finished() || facts.busy || state.loading || (state.playing && state.frames_to_play > 0)) return {};
    const Action& action = player.actions[player.next];
    const bool after_job = action.verb == Verb::render || action.verb == Verb::bake || action.verb == Verb::quit;
    if (after_job && facts.job) return {}; // jobs run one at a time
    if (action.verb == Verb::wait) {
        check_end(action, state);
        if (player.waiting_since < 0) player.waiting_since = facts.now;
        if (!is_over(action, facts, player.waiting_since)) return {};
    }
    player.waiting_since = -1;
    ++player.next;
    return action;
}
}
