#include "base/error.h"
#include "scene/camera.h"
#include "support/expect.h"
#include "viewer/editing/editing.h"
#include "viewer/editing/scene_session.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
void set(SceneSession& session, std::string_view path, std::string_view value, uint64_t drag = 0, double seconds = 0) {
    edit(session, parse_edit(session.scene, path, value, seconds), drag);
}

float exposure(const SceneSession& session) { return session.scene.exposure.at(0); }

// Writes with a time of change that differs from all before.
void write_later(const SceneFolder& studio, const std::string& name, std::string_view text) {
    static int seconds = 10;
    std::filesystem::last_write_time(studio.put(name, text),
                                     std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++seconds));
}
}

TEST(SceneSession, UndoAndRedoGoThroughEveryState) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    std::vector<std::vector<std::string>> states{state_of(session.scene)};
    const std::pair<const char*, const char*> edits[] = {{"exposure", "1"},
                                                         {"lights/0/position", "1 2 3"},
                                                         {"lights/stage/position", "0 5 1"},
                                                         {"media/1/rotate", "0 30 0"},
                                                         {"lights/3/intensity", "99"},
                                                         {"background/sky/horizon", "0.3"}};
    for (const auto& [path, value] : edits) {
        set(session, path, value, 0, 1.25);
        states.push_back(state_of(session.scene));
        EXPECT_NE(states.back(), states[states.size() - 2]) << path;
    }
    for (size_t i = states.size() - 1; i-- > 0;) {
        EXPECT_TRUE(undo(session));
        EXPECT_EQ(state_of(session.scene), states[i]) << i;
    }
    EXPECT_FALSE(undo(session));
    for (size_t i = 1; i < states.size(); ++i) {
        EXPECT_TRUE(redo(session));
        EXPECT_EQ(state_of(session.scene), states[i]) << i;
    }
    EXPECT_FALSE(redo(session));
    undo(session), undo(session);
    set(session, "exposure", "3");
    EXPECT_FALSE(redo(session)) << "a new edit ends what was undone";
}

TEST(SceneSession, ADragIsOneStep) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    for (const char* value : {"1", "1.5", "2"}) set(session, "exposure", value, 7);
    ASSERT_EQ(session.steps.size(), 1u);
    EXPECT_EQ(session.steps[0].edits.size(), 1u);
    set(session, "exposure", "4", 8), set(session, "exposure", "5"), set(session, "exposure", "6");
    EXPECT_EQ(session.steps.size(), 4u);
    undo(session), undo(session), undo(session);
    EXPECT_EQ(exposure(session), 2);
    undo(session);
    EXPECT_EQ(exposure(session), 0.5f);
    redo(session);
    set(session, "exposure", "3", 7);
    EXPECT_EQ(session.steps.size(), 2u) << "undoing ends a drag";
}

// The order within a drag matters where values check each other or share a key.
TEST(SceneSession, ADragOfSeveralValuesIsDoneAgainAsItEnded) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    for (const auto& [path, value] : {std::pair{"lights/5/outer_cone", "60"},
                                      {"lights/5/inner_cone", "50"},
                                      {"lights/5/outer_cone", "55"},
                                      {"lights/5/inner_cone", "2"},
                                      {"lights/5/outer_cone", "3"}})
        set(session, path, value, 1);
    set(session, "lights/3/intensity", "1", 1, 0.25), set(session, "lights/3/intensity", "2", 1, 0.251);
    set(session, "lights/3/intensity", "3", 1, 0.25);
    set(session, "lights/3/intensity", "4", 1, 0.75); // while time goes on
    const std::vector<std::string> ended = state_of(session.scene);
    EXPECT_EQ(session.steps.size(), 1u);
    undo(session), redo(session);
    EXPECT_EQ(state_of(session.scene), ended);
    save(session);
    EXPECT_EQ(state_of(load_scene(studio.file)), ended);
}

TEST(SceneSession, KnowsWhetherThereAreUnsavedChanges) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    EXPECT_FALSE(has_unsaved_changes(session));
    set(session, "exposure", "1"), set(session, "exposure", "2");
    EXPECT_TRUE(has_unsaved_changes(session));
    save(session);
    EXPECT_FALSE(has_unsaved_changes(session));
    undo(session);
    EXPECT_TRUE(has_unsaved_changes(session));
    redo(session);
    EXPECT_FALSE(has_unsaved_changes(session));
    undo(session);
    set(session, "exposure", "2");
    EXPECT_TRUE(has_unsaved_changes(session)) << "another second step than the saved one";
    undo(session), undo(session);
    save(session);
    EXPECT_FALSE(has_unsaved_changes(session));
    EXPECT_EQ(bytes_of(studio.file), rich_scene) << "nothing of an undone edit stays in the file";
    EXPECT_THROW(set(session, "exposure", "100"), Error);
    EXPECT_FALSE(has_unsaved_changes(session)) << "a refused edit is none";
}

TEST(SceneSession, SavesNothingOverSomebodyElsesChange) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    set(session, "exposure", "1");
    const std::string other = replaced(rich_scene, "0.02", "0.5");
    studio.put("scene.json", other);
    EXPECT_THROW(save(session), Error);
    EXPECT_EQ(bytes_of(studio.file), other);
    EXPECT_TRUE(has_unsaved_changes(session));
}

TEST(SceneSession, SavesElsewhereAndGoesOnThere) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    set(session, "media/dust/wind", "1 0 0");
    std::filesystem::create_directories(studio / "takes");
    save_as(session, studio / "takes/second.json");
    EXPECT_FALSE(has_unsaved_changes(session));
    EXPECT_EQ(bytes_of(studio.file), rich_scene);
    EXPECT_EQ(state_of(load_scene(studio / "takes/second.json")), state_of(session.scene));
    set(session, "exposure", "3");
    save(session);
    EXPECT_EQ(load_scene(studio / "takes/second.json").exposure.at(0), 3);
    EXPECT_THROW(save_as(session, studio / "model.glb"), Error);
    EXPECT_THROW(save_as(session, studio / "nowhere/at/all.json"), Error);
    EXPECT_EQ(session.scene.file, studio / "takes/second.json");
}

TEST(SceneSession, ABareModelIsSavedAsAScene) {
    const SceneFolder studio;
    GltfBuilder plain = triangle_gltf();
    studio.put("plain.gltf", plain.json());
    for (const char* name : {"plain.gltf", "room.gltf"}) {
        SceneSession session = open_session(studio / name);
        EXPECT_THROW(save(session), Error) << "has no scene file";
        std::filesystem::create_directories(studio / "new");
        save_as(session, studio / "new/untouched.json");
        EXPECT_EQ(state_of(load_scene(studio / "new/untouched.json")), state_of(load_scene(studio / name))) << name;

        session = open_session(studio / name);
        set(session, "media/default fog/extinction", "0.3"), set(session, "cameras/default/position", "1 2 9");
        set(session, "lights/0/intensity", "12"), set(session, "exposure", "1");
        EXPECT_TRUE(has_unsaved_changes(session));
        save_as(session, studio / "new/edited.json");
        EXPECT_EQ(state_of(load_scene(studio / "new/edited.json")), state_of(session.scene)) << name;
        undo(session);
        save(session);
        EXPECT_EQ(state_of(load_scene(studio / "new/edited.json")), state_of(session.scene)) << name;
    }
}

TEST(SceneSession, ABareVolumeIsSavedAsAScene) {
    const SceneFolder studio;
    write_ball(studio / "ball.vdb");
    SceneSession session = open_session(studio / "ball.vdb");
    // What the viewer shows of a bare volume is what all commands take.
    const Scene bare = load_scene(studio / "ball.vdb");
    EXPECT_EQ(bare.cameras.at(0).position.at(0), session.scene.cameras.at(0).position.at(0));
    EXPECT_EQ(bare.lights.at(0).direction.at(0), session.scene.lights.at(0).direction.at(0));
    EXPECT_EQ(bare.ambient.at(0), session.scene.ambient.at(0));
    EXPECT_EQ(bare.media.at(0).extinction.at(0), session.scene.media.at(0).extinction.at(0));
    ASSERT_EQ(bare.warnings.size(), 1u);
    EXPECT_NE(bare.warnings[0].find("a volume by itself"), std::string::npos);
    ASSERT_EQ(session.scene.media.size(), 1u);
    // Voxels of 0.25 m, centers 0 to 1.75: a box of 2 m, diagonal 2 √3; its densest is 0.5.
    EXPECT_NEAR(session.scene.media[0].extinction.at(0), 4 / (2 * std::sqrt(3.0f) * 0.5f), 1e-4f);
    const Camera camera = look_at(session.scene.cameras[0].position.at(0), session.scene.cameras[0].target.at(0),
                                  vec3(0, 1, 0), session.scene.cameras[0].vertical_fov.at(0));
    for (const vec3 corner : {vec3(-0.125f), vec3(1.875f), vec3(1.875f, -0.125f, 1.875f)}) {
        const auto pixel = pixel_of(camera, {100, 100}, corner);
        ASSERT_TRUE(pixel);
        EXPECT_TRUE(pixel->x > 0 && pixel->x < 100 && pixel->y > 0 && pixel->y < 100);
    }
    set(session, "media/ball/albedo", "0.8");
    save_as(session, studio / "ball.json");
    EXPECT_EQ(state_of(load_scene(studio / "ball.json")), state_of(session.scene));
}

TEST(SceneSession, NoticesFilesThatChange) {
    const SceneFolder studio;
    write_ball(studio / "ball.vdb");
    const std::filesystem::path file = studio.put(
        "with_vdb.json", R"({"tyndall": 1, "gltf": "room.gltf", "media": [{"type": "vdb", "file": "ball.vdb"},
                             {"type": "noise", "recipe": "fog/dust.json"}]})");
    const SceneSession session = open_session(file);
    EXPECT_EQ(session.inputs.size(), 4u);
    EXPECT_TRUE(changed_inputs(session.inputs).empty());
    write_later(studio, "fog/dust.json", dust);
    EXPECT_EQ(changed_inputs(session.inputs), std::vector<std::filesystem::path>{studio / "fog/dust.json"});
    write_later(studio, "ball.vdb", "another");
    EXPECT_EQ(changed_inputs(session.inputs).size(), 2u);

    // An editor that moves the file away and puts a new one in its place.
    const auto before = input_times(session.scene);
    std::filesystem::rename(studio / "room.gltf", studio / "room.gltf~");
    EXPECT_TRUE(changed_inputs(before).empty()) << "away for a moment";
    write_later(studio, "room.tmp", model().json() + " ");
    std::filesystem::rename(studio / "room.tmp", studio / "room.gltf");
    EXPECT_EQ(changed_inputs(before), std::vector<std::filesystem::path>{studio / "room.gltf"});
}

TEST(SceneSession, SavingIsNoChangeToNotice) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    set(session, "exposure", "2.125");
    save(session);
    EXPECT_TRUE(changed_inputs(session.inputs).empty());
}

TEST(SceneSession, ReloadMakesUnsavedEditsAgainAndSaysWhatIsLost) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    set(session, "exposure", "1");
    save(session);
    set(session, "lights/evening/intensity", "7"), set(session, "lights/stage/intensity", "8");
    set(session, "media/1/g", "0.4"), set(session, "media/dust/wind", "2 0 0");
    // Somebody drops the stage light, puts another before the rest and makes the second fog even.
    std::string text = replaced(
        bytes_of(studio.file), "\"lights\": [",
        "\"lights\": [ { \"name\": \"first\", \"type\": \"point\", \"position\": [0, 0, 0], \"intensity\": 1 },");
    text = replaced(text, "\"name\": \"stage\"", "\"name\": \"renamed\"");
    text = replaced(text, "\"name\": \"air\"", "\"name\": \"ether\"");
    write_later(studio, "scene.json", text);
    const std::vector<std::string> lost = reload(session);
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_NE(lost[0].find("lights/stage/intensity"), std::string::npos);
    EXPECT_EQ(session.steps.size(), 3u);
    EXPECT_TRUE(has_unsaved_changes(session));
    EXPECT_EQ(exposure(session), 1);
    const auto evening = std::ranges::find(session.scene.lights, "evening", &LightSource::name);
    ASSERT_NE(evening, session.scene.lights.end());
    EXPECT_EQ(evening->intensity.at(0), 7);
    EXPECT_EQ(session.scene.media[1].g.at(0), 0.4f) << "the second of that name";
    EXPECT_EQ(session.scene.media[0].g.at(0), 0.0f);
    save(session);
    EXPECT_EQ(state_of(load_scene(studio.file)), state_of(session.scene));
    EXPECT_NE(bytes_of(studio.file).find("\"ether\""), std::string::npos);
}

TEST(SceneSession, AReloadThatFailsLeavesEverythingAndWaitsForTheNextChange) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    set(session, "exposure", "1");
    const std::vector<std::string> before = state_of(session.scene);
    write_later(studio, "scene.json", "{ half");
    EXPECT_EQ(changed_inputs(session.inputs).size(), 1u);
    EXPECT_THROW(reload(session), Error);
    EXPECT_EQ(state_of(session.scene), before);
    EXPECT_TRUE(changed_inputs(session.inputs).empty());
    EXPECT_TRUE(undo(session));
    redo(session);
    write_later(studio, "scene.json", rich_scene);
    EXPECT_EQ(changed_inputs(session.inputs).size(), 1u);
    EXPECT_TRUE(reload(session).empty());
    EXPECT_EQ(state_of(session.scene), before);
}

TEST(SceneSession, ReloadAfterUndoingWhatWasSavedSaysSo) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    set(session, "exposure", "1"), set(session, "ambient", "0.5");
    save(session);
    undo(session);
    set(session, "lights/evening/intensity", "9");
    const std::vector<std::string> lost = reload(session);
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_NE(lost[0].find("undone"), std::string::npos);
    EXPECT_EQ(session.scene.ambient.at(0), vec3(0.5f));
    EXPECT_EQ(session.scene.lights[6].intensity.at(0), 9) << "the edit made since is kept";
    EXPECT_TRUE(has_unsaved_changes(session));
}
}
