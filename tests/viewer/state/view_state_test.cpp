#include "modes/mode.h"
#include "scene/scene.h"
#include "viewer/fixtures.h"
#include "viewer/state/script_player.h"
#include "viewer/state/setting_groups.h"

#include <gtest/gtest.h>

#include <set>

namespace tyndall::test {
namespace {
ViewState state_with_scene() {
    ViewState state;
    take_scene(state, small_scene());
    return state;
}

}

TEST(ViewState, PicturesChangeWithWhatTheyAreMadeOfAndNotWithHowTheyAreShown) {
    ViewState state = state_with_scene();
    for (const char* line : {"mode cone", "beside froxel", "beside reference", "beside", "set march.nodes 7",
                             "reset march.nodes", "quality draft", "camera side", "orbit 1 2", "turn 1 2", "pan 0.1 0",
                             "dolly 0.9", "fly 0 0 1", "size 20 10", "frame 3"}) {
        const uint64_t before = state.revision, shown = state.shown_revision;
        act(state, line);
        EXPECT_GT(state.revision, before) << line;
        EXPECT_EQ(state.shown_revision, shown) << line;
    }
    for (const char* line : {"exposure auto", "exposure 1", "brighten 0.5", "view-transform srgb", "arrange side",
                             "show error", "show fog", "wipe 0.3"}) {
        const uint64_t before = state.revision, shown = state.shown_revision;
        act(state, line);
        EXPECT_EQ(state.revision, before) << line;
        EXPECT_GT(state.shown_revision, shown) << line;
    }
    EXPECT_EQ(state.shown.exposure, 1.5);
    EXPECT_EQ(state.shown.transform, ViewTransform::srgb);
    EXPECT_EQ(state.shown.layer, ShownLayer::fog);
}

TEST(ViewState, AMeasuredExposureIsKeptUntilThePictureIsAnother) {
    ViewState state = state_with_scene();
    EXPECT_FALSE(request_of(state, false).shown.exposure);
    state.measured = -3;
    for (const char* line : {"orbit 1 2", "camera", "frame 3", "edit lights/0/intensity 9", "mode cone"}) {
        act(state, line);
        EXPECT_EQ(request_of(state, false).shown.exposure, -3) << line;
    }
    act(state, "brighten 0.5");
    EXPECT_EQ(state.shown.exposure, -2.5);
    act(state, "exposure scene");
    EXPECT_EQ(request_of(state, false).shown.exposure, -3);
    for (const char* line : {"camera side", "exposure auto"}) {
        const int before = request_of(state, false).metering_id;
        act(state, line);
        EXPECT_FALSE(request_of(state, false).shown.exposure) << line;
        EXPECT_GT(request_of(state, false).metering_id, before) << line;
        state.measured = -3;
    }
    act(state, "edit exposure 2");
    EXPECT_TRUE(shows_scene_exposure(state));
    EXPECT_EQ(request_of(state, false).shown.exposure, 2);
    act(state, "undo");
    EXPECT_FALSE(shows_scene_exposure(state));
}

TEST(ViewState, MistakesChangeNothing) {
    ViewState state = state_with_scene();
    for (const char* line :
         {"mode marsh", "beside marsh", "exposure bright", "exposure 101", "zoom 100", "zoom big", "set march.nodes 99",
          "set march.nods 4", "reset nodes", "quality best", "show fogs", "camera back", "dolly 0", "size 0 10",
          "orders 0", "tab fog", "select fog", "select lights/moon"}) {
        const uint64_t before = state.revision;
        error_message(ExitCode::usage, [&] { act(state, line); });
        EXPECT_EQ(state.revision, before) << line;
    }
}

TEST(ViewState, TheCameraFollowsTheSceneUntilItIsMoved) {
    ViewState state = state_with_scene();
    act(state, "camera side");
    act(state, "frame 24");
    EXPECT_NEAR(request_of(state, false).camera.position.y, 2, 1e-5f); // animated
    act(state, "pan 0 0");
    act(state, "frame 1");
    EXPECT_NEAR(request_of(state, false).camera.position.y, 2, 1e-5f); // free
    act(state, "camera side");
    EXPECT_NEAR(request_of(state, false).camera.position.y, 1 + 1.0f / 24, 1e-5f);
    EXPECT_EQ(request_of(state, false).camera.name, "side");
}

TEST(ViewState, AnotherSceneBeginsAnewAndTheSameOneStays) {
    ViewState state = state_with_scene();
    act(state, "frame 3");
    act(state, "orbit 5 5");
    take_scene(state, small_scene());
    EXPECT_TRUE(state.free_camera);
    EXPECT_EQ(state.frame, 3);
    take_scene(state, small_scene("other.json"));
    EXPECT_FALSE(state.free_camera);
    EXPECT_EQ(state.frame, 1);
}

TEST(ViewState, PlayingWaitsForPicturesAndKeepsTheRate) {
    ViewState state = state_with_scene();
    act(state, "play");
    const double period = 1.0 / 24;
    advance(state, 10, 0); // no picture yet
    EXPECT_EQ(state.frame, 1);
    advance(state, 10, state.revision);
    EXPECT_EQ(state.frame, 2);
    advance(state, 10 + 0.5 * period, state.revision);
    EXPECT_EQ(state.frame, 2) << "too early";
    advance(state, 10 + 1.01 * period, state.revision);
    EXPECT_EQ(state.frame, 3);
    advance(state, 10 + 2.01 * period, state.revision);
    EXPECT_EQ(state.frame, 4);
    advance(state, 10 + 3.01 * period, state.revision);
    EXPECT_EQ(state.frame, 1) << "loops";
    act(state, "loop off");
    act(state, "frame 4");
    advance(state, 20, state.revision);
    EXPECT_FALSE(state.playing);
}

TEST(ViewState, PlayNStopsAfterNPictures) {
    ViewState state = state_with_scene();
    act(state, "play 6");
    int pictures = 0;
    for (double now = 0; state.playing && now < 10; now += 0.05) {
        ++pictures;
        advance(state, now, state.revision);
    }
    EXPECT_EQ(pictures, 6);
    EXPECT_EQ(state.frame, 2); // 1 2 3 4 1 2
}

TEST(ViewState, KeysAreActions) {
    ViewState state = state_with_scene();
    for (size_t i = 0; i < modes().size(); ++i) {
        const auto action = action_of_key(state, std::to_string(i + 1));
        ASSERT_TRUE(action);
        apply(state, *action);
        EXPECT_EQ(state.mode, modes()[i].name);
    }
    EXPECT_FALSE(action_of_key(state, "9"));
    EXPECT_FALSE(action_of_key(state, "x"));
    apply(state, *action_of_key(state, "space"));
    EXPECT_TRUE(state.playing);
    apply(state, *action_of_key(state, "space"));
    EXPECT_FALSE(state.playing);
    apply(state, *action_of_key(state, "w"));
    EXPECT_TRUE(state.free_camera);
    EXPECT_LT(state.view.camera.position.z, 4);
    apply(state, *action_of_key(state, "home"));
    EXPECT_FALSE(state.free_camera);
    apply(state, *action_of_key(state, "right"));
    EXPECT_EQ(state.frame, 2);
    apply(state, *action_of_key(state, "t"));
    EXPECT_TRUE(state.lights_tab);
    apply(state, *action_of_key(state, "g"));
    EXPECT_FALSE(state.handles);
    apply(state, parse_action("edit ambient 1"));
    apply(state, *action_of_key(state, "ctrl+z"));
    EXPECT_EQ(state.scene->ambient.at(0), vec3(0));
    for (const char* key : {"ctrl+y", "ctrl+shift+z"}) EXPECT_EQ(action_of_key(state, key)->verb, Verb::redo);
    EXPECT_EQ(action_of_key(state, "ctrl+s")->verb, Verb::save);
    EXPECT_FALSE(action_of_key(state, "ctrl+w"));
    const auto write = action_of_key(state, "p");
    ASSERT_TRUE(write);
    EXPECT_EQ(write->verb, Verb::snapshot);
}

TEST(ViewState, ScriptsDoJobsOneAfterTheOther) {
    ViewState state = state_with_scene();
    ScriptPlayer player{parse_script("render a.####.exr 1-2\nbake haze b.####.vdb\nwait job\nquit", "c.txt")};
    ScriptFacts facts;
    const auto verb = [&]() -> std::optional<Verb> {
        const std::optional<Action> action = next_action(player, state, facts);
        return action ? std::optional(action->verb) : std::nullopt;
    };
    EXPECT_EQ(verb(), Verb::render);
    facts.job = true;
    EXPECT_EQ(verb(), std::nullopt);
    facts.job = false;
    EXPECT_EQ(verb(), Verb::bake);
    facts.job = true;
    EXPECT_EQ(verb(), std::nullopt);
    facts.job = false;
    EXPECT_EQ(verb(), Verb::wait);
    facts.job = true;
    EXPECT_EQ(verb(), std::nullopt) << "quitting would end it";
    facts.job = false;
    EXPECT_EQ(verb(), Verb::quit);
}

TEST(ViewState, ScriptsDoNotWaitForWhatNeverComes) {
    ViewState state = state_with_scene();
    state.max_samples = 8;
    ScriptPlayer samples{parse_script("wait samples 9", "c.txt")}, idle{parse_script("wait idle", "c.txt")};
    error_message(ExitCode::usage, [&] { next_action(samples, state, {}); });
    apply(state, parse_action("play"));
    error_message(ExitCode::usage, [&] { next_action(idle, state, {}); });
}

TEST(ViewState, ScriptsWaitForWhatTheyAskFor) {
    ViewState state = state_with_scene();
    ScriptPlayer player{parse_script("wait idle\nwait 2\nwait samples 8\nplay 2\nquit", "c.txt")};
    const auto next = [&](ScriptFacts facts) { return next_action(player, state, facts); };
    EXPECT_FALSE(next({1, false, 0, false}));
    EXPECT_TRUE(next({1, true, 0, false}));
    EXPECT_FALSE(next({10, true, 0, false})); // begins to wait
    EXPECT_FALSE(next({11.9, true, 0, false}));
    EXPECT_FALSE(next({12.1, true, 0, true})) << "busy";
    EXPECT_TRUE(next({12.1, true, 0, false}));
    EXPECT_FALSE(next({12.1, true, 7, false}));
    EXPECT_TRUE(next({12.1, true, 8, false}));
    apply(state, *next({12.1, true, 8, false}));
    EXPECT_FALSE(next({12.1, true, 8, false})) << "plays";
    state.playing = false;
    EXPECT_EQ(next({12.1, true, 8, false})->verb, Verb::quit);
    EXPECT_TRUE(player.finished());
}

TEST(SettingGroups, EveryModeShowsItsOwnRowsFirstAndNoRowTwice) {
    for (const Mode& mode : modes()) {
        std::set<std::string> names;
        const auto groups = setting_groups(mode);
        ASSERT_FALSE(groups.empty());
        EXPECT_EQ(groups[0].title, mode.name);
        for (const SettingGroup& group : groups) {
            EXPECT_FALSE(group.rows.empty()) << mode.name << " " << group.title;
            for (const SettingRow* row : group.rows) EXPECT_TRUE(names.insert(row->name).second) << row->name;
        }
    }
}

TEST(SettingGroups, SlidersHoldTheirValuesAndStayInRange) {
    const Settings usual = settings_for(Quality::preview);
    for (const SettingRow& row : setting_rows()) {
        if (!row.choices.empty() || row.parts != 1) continue;
        const double normal = std::stod(row.get(usual));
        for (const double value : {row.low, normal, row.high}) {
            const SliderRange range = slider_range(row, normal, value);
            EXPECT_LE(range.low, value) << row.name;
            EXPECT_GE(range.high, value) << row.name;
            EXPECT_GE(range.low, row.low) << row.name;
            EXPECT_LE(range.high, row.high) << row.name;
            EXPECT_LT(range.low, range.high) << row.name;
            EXPECT_TRUE(!range.logarithmic || range.low > 0) << row.name;
        }
    }
    EXPECT_EQ(label_of(find_row("froxel.depth_slices")), "depth slices");
    EXPECT_NE(error_message(ExitCode::usage, [] { find_row("froxel.slices"); }).find("did you mean"),
              std::string::npos);
}
}
