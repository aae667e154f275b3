// What is seen after an edit is what the saved file gives, to the bit.
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "viewer/editing/editing.h"
#include "viewer/editing/scene_session.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

#include <cstring>

namespace tyndall::test {
namespace {
Image<vec3> picture(const Scene& scene, int frame, const Snapshot& snapshot) {
    View view;
    view.camera = camera_at(scene, scene.camera, moment_of(scene, frame).seconds);
    view.size = {24, 14}, view.pixel_samples = 1, view.frame = frame;
    FrameStats stats;
    const Settings settings = settings_for(Quality::draft);
    return render_frame(find_mode("march"), view, snapshot, settings, {}, stats).color;
}

Image<vec3> picture(const Scene& scene, int frame) {
    return picture(scene, frame, make_snapshot(scene, moment_of(scene, frame)));
}

size_t different(const Image<vec3>& a, const Image<vec3>& b) {
    size_t count = 0;
    for (int y = 0; y < 14; ++y)
        for (int x = 0; x < 24; ++x) count += std::memcmp(&a.at(x, y), &b.at(x, y), sizeof(vec3)) != 0;
    return count;
}

void set(SceneSession& session, std::string_view path, std::string_view value, double seconds) {
    edit(session, parse_edit(session.scene, path, value, seconds));
}
}

TEST(EditedPictures, SavedAndReadAgainTheyAreTheSame) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    const Image<vec3> untouched = picture(session.scene, 13);
    const std::pair<const char*, const char*> edits[] = {{"lights/0/position", "1.1 2.7 0.3"},
                                                         {"lights/3/intensity", "33.3"},
                                                         {"lights/stage/position", "0.1 2.9 0.7"},
                                                         {"lights/5/outer_cone", "47.7"},
                                                         {"lights/evening/color", "0.9 0.1 0.3"},
                                                         {"media/1/extinction", "0.123"},
                                                         {"media/1/rotate", "3 33 7"},
                                                         {"media/dust/wind", "0.7 0.1 0"},
                                                         {"media/dust/g", "0.77"},
                                                         {"ambient", "0.1 0.11 0.12"},
                                                         {"cameras/eye/vertical_fov", "51.7"},
                                                         {"cameras/eye/aperture_radius", "0.05"},
                                                         {"cameras/eye/focus_distance", "2.5"},
                                                         {"background/sky/horizon", "0.3 0.2 0.1"}};
    Image<vec3> last = untouched;
    for (const auto& [path, value] : edits) {
        set(session, path, value, 13.0 / 24);
        const Image<vec3> next = picture(session.scene, 13);
        EXPECT_GT(different(last, next), 0u) << path << " is seen";
        last = next;
    }
    const Image<vec3> later = picture(session.scene, 30);
    save(session);
    EXPECT_EQ(different(picture(load_scene(studio.file), 13), last), 0u);
    EXPECT_EQ(different(picture(load_scene(studio.file), 30), later), 0u);
    while (undo(session)) {}
    EXPECT_EQ(different(picture(session.scene, 13), untouched), 0u);
}

TEST(EditedPictures, ABareModelAndItsSceneFileAreTheSame) {
    const SceneFolder studio;
    SceneSession session = open_session(studio / "room.gltf");
    save_as(session, studio / "room.json");
    EXPECT_EQ(different(picture(load_scene(studio / "room.json"), 1), picture(load_scene(studio / "room.gltf"), 1)),
              0u);
}

// A viewer makes the next snapshot out of the one before the edit: nothing old may show.
TEST(EditedPictures, SnapshotsOfAnEditedSceneMayShareWithThoseBefore) {
    const SceneFolder studio;
    SceneSession session = open_session(studio.file);
    auto before = std::make_unique<Snapshot>(make_snapshot(session.scene, moment_of(session.scene, 13)));
    picture(session.scene, 13, *before);
    for (const auto& [path, value] : {std::pair{"lights/0/position", "1.1 2.7 0.3"},
                                      {"lights/3/position", "0.5 1 0.2"},
                                      {"media/dust/wind", "0.7 0.1 0"},
                                      {"media/1/translate", "0 0.5 0"},
                                      {"lights/5/radius", "0.2"},
                                      {"media/dust/extinction", "0"},
                                      {"media/dust/extinction", "0.6"},
                                      {"lights/evening/shadows", "off"}}) {
        set(session, path, value, 13.0 / 24);
        auto now = std::make_unique<Snapshot>(make_snapshot(session.scene, moment_of(session.scene, 13), before.get()));
        EXPECT_EQ(different(picture(session.scene, 13, *now), picture(session.scene, 13)), 0u) << path;
        before = std::move(now);
    }
}
}
