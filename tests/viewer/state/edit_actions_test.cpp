// Editing through actions, as hands and scripts do it.
#include "base/io/file.h"
#include "scene/scene.h"
#include "viewer/editing/editing.h"
#include "viewer/editing/scene_edit.h"
#include "viewer/editing/scene_loader.h"
#include "viewer/fixtures.h"
#include "viewer/state/edit_actions.h"
#include "viewer/state/view_state.h"

#include <gtest/gtest.h>

#include <bit>

namespace tyndall::test {
namespace {
struct Edited {
    SceneFolder studio;
    ViewState state;
    explicit Edited(std::string_view text = rich_scene) : studio(text) { open(studio.file); }

    void open(const std::filesystem::path& file) {
        auto session = std::make_shared<SceneSession>(open_session(file));
        auto stage = std::make_shared<Scene>(session->scene);
        tyndall::take_scene(state, {file, std::move(session), std::move(stage), {}, ExitCode::ok});
    }
    void operator()(const std::string& line) { apply(state, parse_action(line)); }
};

}

TEST(EditActions, EditsAreSeenAndUndone) {
    Edited edited;
    const float before = edited.state.scene->lights[6].intensity.at(0);
    const uint64_t revision = edited.state.revision, motions = edited.state.motions;
    edited("edit lights/evening/intensity 123");
    EXPECT_EQ(edited.state.scene->lights[6].intensity.at(0), 123);
    EXPECT_EQ(request_of(edited.state, true).edited->lights[6].intensity.at(0), 123);
    EXPECT_EQ(edited.state.revision, revision + 1);
    EXPECT_EQ(edited.state.motions, motions + 1) << "as moving the camera does";
    EXPECT_TRUE(has_unsaved_changes(*edited.state.session));
    edited("undo");
    EXPECT_EQ(edited.state.scene->lights[6].intensity.at(0), before);
    EXPECT_EQ(request_of(edited.state, true).edited->lights[6].intensity.at(0), before);
    edited("redo");
    EXPECT_EQ(edited.state.scene->lights[6].intensity.at(0), 123);
    const uint64_t last = edited.state.revision;
    edited("redo");
    EXPECT_EQ(edited.state.revision, last);
    EXPECT_EQ(edited.state.message, "nothing to redo");
}

TEST(EditActions, ExposureIsHowAPictureIsShown) {
    Edited edited;
    const uint64_t revision = edited.state.revision, shown = edited.state.shown_revision;
    edited("edit exposure 2.5");
    EXPECT_EQ(edited.state.revision, revision);
    EXPECT_GT(edited.state.shown_revision, shown);
    EXPECT_EQ(request_of(edited.state, false).shown.exposure, 2.5);
    edited("undo");
    EXPECT_EQ(request_of(edited.state, false).shown.exposure, 0.5);
}

TEST(EditActions, ValuesWithKeysGetThemAtTheFrameShown) {
    Edited edited;
    edited("frame 36");
    edited("edit media/1/extinction 0.7");
    const Keyed<float>& keys = edited.state.scene->media[1].extinction;
    EXPECT_EQ(keys.times, (std::vector<float>{0, 1.5f, 2}));
    EXPECT_EQ(keys.values[1], 0.7f);
}

TEST(EditActions, ADragIsOneStepAndCanBeTakenBackForGood) {
    Edited edited;
    edited("edit ambient 0.3");
    for (const char* line : {"edit lights/5/position \"1 1 1\" 7", "edit lights/5/position \"2 1 1\" 7"}) edited(line);
    EXPECT_EQ(edited.state.session->done, 2u);
    edited("cancel 6");
    EXPECT_EQ(edited.state.session->done, 2u) << "another drag";
    edited("cancel 7");
    EXPECT_EQ(edited.state.scene->lights[5].position.at(0), vec3(2, 3, 1));
    edited("redo");
    EXPECT_EQ(edited.state.scene->lights[5].position.at(0), vec3(2, 3, 1)) << "it is not there to be done again";
    EXPECT_EQ(edited.state.scene->ambient.at(0), vec3(0.3f));
}

TEST(EditActions, RefusedEditsChangeNothing) {
    Edited edited;
    const std::vector<std::string> before = state_of(*edited.state.scene);
    const uint64_t revision = edited.state.revision;
    EXPECT_NE(error_message(ExitCode::refused, [&] { edited("edit lights/5/outer_cone 5"); }).find("inner_cone"),
              std::string::npos);
    error_message(ExitCode::usage, [&] { edited("edit lights/nobody/intensity 5"); });
    error_message(ExitCode::usage, [&] { edited("edit media/0/color 5"); });
    EXPECT_EQ(state_of(*edited.state.scene), before);
    EXPECT_EQ(edited.state.revision, revision);
    EXPECT_FALSE(has_unsaved_changes(*edited.state.session));
    ViewState empty;
    error_message(ExitCode::usage, [&] { apply(empty, parse_action("undo")); });
}

TEST(EditActions, SavingWritesAndAnotherFileIsGoneOnWith) {
    Edited edited;
    edited("edit lights/evening/intensity 31");
    edited("save");
    EXPECT_EQ(load_scene(edited.studio.file).lights[6].intensity.at(0), 31);
    EXPECT_FALSE(has_unsaved_changes(*edited.state.session));
    const std::filesystem::path other = edited.studio / "other.json";
    edited("edit lights/evening/intensity 32");
    edited("save-as " + other.string());
    EXPECT_EQ(load_scene(edited.studio.file).lights[6].intensity.at(0), 31);
    EXPECT_EQ(load_scene(other).lights[6].intensity.at(0), 32);
    EXPECT_EQ(edited.state.scene_file, other);
    EXPECT_EQ(request_of(edited.state, false).scene->file, other) << "pictures name it";
}

TEST(EditActions, UnsavedEditsSurviveReadingAgainAndLostOnesAreTold) {
    Edited edited;
    edited("edit lights/evening/intensity 31");
    edited("edit media/dust/g 0.4");
    std::string text = read_file(edited.studio.file);
    text.replace(text.find("\"dust\""), 6, "\"smoke\"");
    const size_t stage = text.find("    { \"name\": \"stage\""), next = text.find("    { \"type\": \"spot\"");
    text.erase(stage, next - stage);
    edited("select lights/evening");
    edited.studio.put("scene.json", text);
    edited.state.reloading = true;
    edited.open(edited.studio.file);
    EXPECT_EQ(edited.state.scene->lights.back().intensity.at(0), 31);
    EXPECT_TRUE(edited.state.message_is_error);
    EXPECT_NE(edited.state.message.find("media/dust/g"), std::string::npos) << edited.state.message;
    EXPECT_FALSE(edited.state.reloading);
    EXPECT_EQ(edited.state.selected, (PartRef{Part::light, 5})) << "where it stands now";
    edited.open(edited.studio.file); // asked for: as the file is
    EXPECT_NE(edited.state.scene->lights.back().intensity.at(0), 31);
    EXPECT_FALSE(has_unsaved_changes(*edited.state.session));
}

TEST(EditActions, AReloadThatComesAfterSavingElsewhereIsForgotten) {
    Edited edited;
    edited.state.reloading = true;
    edited("edit ambient 0.3");
    edited("save-as " + (edited.studio / "other.json").string());
    edited("edit ambient 0.4");
    edited.open(edited.studio.file);
    EXPECT_EQ(edited.state.scene->file, edited.studio / "other.json");
    EXPECT_EQ(edited.state.scene->ambient.at(0), vec3(0.4f));
}

TEST(EditActions, ActionsOfEditsAreTheirWords) {
    Edited edited;
    Scene scene = *edited.state.scene;
    scene.lights[0].name = "a/b~c";
    scene.lights[1].name = scene.lights[2].name = "twin", scene.lights[4].name = "1";
    const Edit edits[] = {{Part::light, 0, "intensity", vec3(0.1f, 0, 0), 0},
                          {Part::light, 2, "position", vec3(1 / 3.0f, -2e-7f, 1e9f), 0},
                          {Part::light, 1, "intensity", vec3(7, 0, 0), 0},
                          {Part::light, 4, "intensity", vec3(8, 0, 0), 0},
                          {Part::light, 6, "shadows", vec3(0), 0},
                          {Part::medium, 1, "rotate", vec3(1.1f, 2.2f, 3.3f), 0},
                          {Part::scene, 0, "background/sky/zenith", vec3(0.7f), 0}};
    for (const Edit& edit : edits) {
        const Action action = action_of(scene, edit, 5);
        EXPECT_EQ(action.numbers, std::vector<double>{5});
        const Edit again = parse_edit(scene, action.words[0], action.words[1], 0);
        EXPECT_EQ(again.part, edit.part) << action.words[0];
        EXPECT_EQ(again.index, edit.index) << action.words[0];
        EXPECT_EQ(again.property, edit.property);
        EXPECT_EQ(again.value, edit.value) << action.words[1];
    }
}

TEST(EditActions, UnsavedEditsAreNotedInWrittenPictures) {
    Edited edited;
    EXPECT_EQ(unsaved_text(*edited.state.session), "");
    edited("edit lights/evening/intensity 31");
    const std::string text = unsaved_text(*edited.state.session);
    EXPECT_EQ(text.find("lights/evening/intensity = 31 0 0 at 0.0416666667 s\nscene "), 0u) << text;
    edited("save");
    EXPECT_EQ(unsaved_text(*edited.state.session), "");
    edited("undo");
    const std::string undone = unsaved_text(*edited.state.session);
    EXPECT_EQ(undone.find("without the last 1 steps that were saved\nscene "), 0u) << undone;
    edited("redo");
    edited("edit lights/evening/intensity 44");
    edited("edit lights/evening/intensity 31");
    edited("save");
    edited("undo");
    EXPECT_NE(unsaved_text(*edited.state.session), undone) << "44 now, 3 then";
}

TEST(EditActions, HandsAreAskedBeforeEditsAreLost) {
    Edited edited;
    const std::filesystem::path own = edited.studio.file;
    edited("close");
    EXPECT_TRUE(edited.state.closing) << "nothing to lose";
    edited.state.closing = false;
    edited("edit ambient 0.3");

    edited("close");
    EXPECT_FALSE(edited.state.closing);
    ASSERT_TRUE(edited.state.asked);
    edited("answer cancel");
    EXPECT_FALSE(edited.state.asked || edited.state.closing);

    edited("open other.json");
    ASSERT_TRUE(edited.state.asked);
    EXPECT_EQ(edited.state.loads, 0);
    error_message(ExitCode::usage, [&] { edited("answer maybe"); });
    edited("answer discard");
    EXPECT_EQ(edited.state.loads, 1);
    EXPECT_EQ(edited.state.scene_file, "other.json");
    error_message(ExitCode::usage, [&] { edited("answer save"); });

    apply(edited.state, parse_action("open third.json", "script.txt:1"));
    EXPECT_EQ(edited.state.loads, 2) << "scripts know what they do";
    error_message(ExitCode::usage, [&] { edited("edit ambient 0.5"); }); // it would be lost in a moment

    edited.state.loading = false;
    edited("close");
    edited("answer save");
    EXPECT_TRUE(edited.state.closing);
    EXPECT_EQ(load_scene(own).ambient.at(0), vec3(0.3f));
}

TEST(EditActions, WhatCannotBeSavedIsAskedOn) {
    Edited edited;
    edited("edit ambient 0.3");
    edited("close");
    edited.studio.put("scene.json", "{}"); // by somebody else
    error_message(ExitCode::refused, [&] { edited("answer save"); });
    EXPECT_TRUE(edited.state.asked);
    EXPECT_FALSE(edited.state.closing);
}
}
