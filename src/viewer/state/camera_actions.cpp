// Actions that move the camera or change the size of the image.
#include "base/error.h"
#include "trace/moment.h"
#include "viewer/state/verb_actions.h"

namespace tyndall {
namespace {
constexpr double largest_side = 16384;

void move(ViewState& state, const Viewpoint& view) {
    state.view = view;
    state.view.camera.name = "view";
    state.free_camera = true;
    ++state.revision, ++state.motions;
}

vec2 pair_of(const Action& action) { return {action.numbers[0], action.numbers[1]}; }

void orbit(ViewState& state, const Action& action) {
    move(state, orbited(viewpoint(state), glm::radians(pair_of(action))));
}
void turn(ViewState& state, const Action& action) {
    move(state, turned(viewpoint(state), glm::radians(pair_of(action))));
}
void pan(ViewState& state, const Action& action) { move(state, panned(viewpoint(state), pair_of(action))); }

void dolly(ViewState& state, const Action& action) {
    if (!(action.numbers[0] > 0)) fail(ExitCode::usage, "dolly", "expected a factor above 0");
    move(state, dollied(viewpoint(state), static_cast<float>(action.numbers[0])));
}

void fly(ViewState& state, const Action& action) {
    move(state, flown(viewpoint(state), vec3(pair_of(action), action.numbers[2])));
}

void set_camera(ViewState& state, const Action& action) {
    const std::string name = action.words.empty() ? "" : action.words[0];
    const Scene& scene = loaded_scene(state);
    if (find_camera(scene, name) != find_camera(scene, state.camera)) measure_again(state);
    state.camera = name, state.free_camera = false;
    ++state.revision;
}

void set_size(ViewState& state, const Action& action) {
    const double x = action.numbers[0], y = action.numbers[1];
    const bool scenes_own = x == 0 && y == 0;
    if (!scenes_own && !(x >= 1 && y >= 1 && x <= largest_side && y <= largest_side))
        fail(ExitCode::usage, "size", "expected 1 to 16384 pixels on each side, or 0 0 for the scene's");
    state.size = {static_cast<int>(x), static_cast<int>(y)};
    state.explain.reset(); // its pixel belongs to the old size
    ++state.revision;
}

constexpr VerbAction table[] = {
    {Verb::orbit, orbit}, {Verb::turn, turn},         {Verb::pan, pan},       {Verb::dolly, dolly},
    {Verb::fly, fly},     {Verb::camera, set_camera}, {Verb::size, set_size},
};
}

std::span<const VerbAction> camera_actions() { return table; }
}
