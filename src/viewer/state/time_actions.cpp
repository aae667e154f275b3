// Actions on frames, playback, and missing frames.
#include "scene/scene.h"
#include "viewer/state/verb_actions.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
// Frames outside of the scene's range are fine: animations hold or repeat there.
void go_to(ViewState& state, double frame) {
    const int wanted = static_cast<int>(std::round(frame));
    if (wanted == state.frame) return;
    state.frame = wanted;
    ++state.revision, ++state.motions;
}

void set_frame(ViewState& state, const Action& action) { go_to(state, action.numbers[0]); }

void step(ViewState& state, const Action& action) {
    state.playing = false;
    go_to(state, state.frame + action.numbers[0]);
}

void play(ViewState& state, const Action& action) {
    const Scene& scene = loaded_scene(state);
    state.playing = true, state.next_frame_at = 0;
    state.frames_to_play = action.numbers.empty() ? 0 : static_cast<int>(std::max(action.numbers[0], 1.0));
    if (!state.loop && state.frame >= scene.last_frame) go_to(state, scene.first_frame);
}

void set_missing(ViewState& state, const Action& action) {
    const std::string& word = action.words[0];
    state.missing = word == "hold" ? MissingFrame::hold : word == "skip" ? MissingFrame::skip : MissingFrame::error;
    ++state.revision;
}

constexpr VerbAction table[] = {
    {Verb::frame, set_frame},
    {Verb::step, step},
    {Verb::play, play},
    {Verb::stop, [](ViewState& state, const Action&) { state.playing = false; }},
    {Verb::loop, [](ViewState& state, const Action& action) { state.loop = is_on(action); }},
    {Verb::missing, set_missing},
};
}

std::span<const VerbAction> time_actions() { return table; }
}
