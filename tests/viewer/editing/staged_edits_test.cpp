// Edits on their way to the renderer: its scene stays one object, and what edits leave alone is kept.
#include "base/io/file.h"
#include "scene/light.h"
#include "viewer/editing/editable_parts.h"
#include "viewer/editing/scene_edit.h"
#include "viewer/fixtures.h"
#include "viewer/painting/painter.h"
#include "viewer/painting/save_picture.h"
#include "viewer/state/edit_actions.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
std::atomic<bool> never_cancelled = false;

ViewState small_state() {
    ViewState state;
    take_scene(state, small_scene());
    state.max_samples = 4, state.shown.exposure = 0;
    return state;
}

// The finished picture.
std::vector<glm::u8vec4> painted(Painter& painter, const Request& request) {
    Image<glm::u8vec4> codes;
    while (const auto picture = paint(painter, request, never_cancelled)) codes = picture->codes;
    return codes.pixels;
}
}

TEST(StagedEdits, PicturesFollowEditsAndKeepTheTriangles) {
    ViewState state = small_state();
    Painter painter;
    const auto first = painted(painter, request_of(state, false));
    const std::shared_ptr<const Occluders> triangles = painter.snapshot.occluders;
    act(state, "edit lights/sun/intensity 9");
    const auto second = painted(painter, request_of(state, false));
    EXPECT_NE(first, second);
    EXPECT_EQ(painter.snapshot.occluders, triangles);
    act(state, "edit media/haze/extinction 0.7");
    EXPECT_NE(painted(painter, request_of(state, false)), second);
    act(state, "undo");
    act(state, "undo");
    EXPECT_EQ(painted(painter, request_of(state, false)), first);

    // What was read again is another scene.
    take_scene(state, small_scene());
    painted(painter, request_of(state, false));
    EXPECT_NE(painter.snapshot.occluders, triangles);
}

TEST(StagedEdits, AFileHasTheEditsOfItsTimeAndLeavesTheNextPicturesAlone) {
    TempFolder directory;
    ViewState state = small_state();
    act(state, "edit lights/sun/intensity 9");
    SaveJob before;
    before.request = request_of(state, false), before.file = directory.path() / "a.png";
    act(state, "edit lights/sun/intensity 2");
    const Request request = request_of(state, false);
    Painter painter, fresh;
    paint(painter, request, never_cancelled);
    save_picture(before, &painter.snapshot, never_cancelled, {});
    EXPECT_EQ(painted(painter, request), painted(fresh, request));
    before.file = directory.path() / "b.png";
    save_picture(before, nullptr, never_cancelled, {});
    EXPECT_EQ(read_file(directory.path() / "a.png"), read_file(directory.path() / "b.png"));
    before.request = request, before.file = directory.path() / "c.png";
    save_picture(before, nullptr, never_cancelled, {});
    EXPECT_NE(read_file(directory.path() / "a.png"), read_file(directory.path() / "c.png"));
}

TEST(StagedEdits, AFileIsThatOfTheEditedSceneThoughTheViewerKnewItSmaller) {
    TempFolder directory;
    ViewState state = small_state();
    Painter painter;
    paint(painter, request_of(state, false), never_cancelled);
    act(state, "edit media/haze/translate \"70 0 0\"");
    paint(painter, request_of(state, false), never_cancelled);
    SaveJob job;
    job.request = request_of(state, false);
    job.request.settings.march.visibility = Visibility::maps; // aligned to the scene's extent
    job.file = directory.path() / "a.exr";
    const auto saved = [&](const Snapshot* previous) {
        save_picture(job, previous, never_cancelled, {});
        return read_file(job.file);
    };
    EXPECT_TRUE(saved(&painter.snapshot) == saved(nullptr));
}

// A refused snapshot must not be taken for the one that was asked for.
TEST(StagedEdits, AfterAMistakeTheSceneIsMadeAnew) {
    ViewState state = small_state();
    Painter painter, fresh;
    painted(painter, request_of(state, false));
    Request broken = request_of(state, false);
    auto parts = std::make_shared<EditableParts>(*broken.edited);
    parts->lights[0].direction = Keyed<vec3>(vec3(0));
    broken.edited = parts, ++broken.revision;
    EXPECT_NE(paint(painter, broken, never_cancelled)->error, "");
    state.revision += 2;
    act(state, "edit lights/sun/intensity 9");
    EXPECT_EQ(painted(painter, request_of(state, false)), painted(fresh, request_of(state, false)));
}

// What is kept of other moments, and the truth that pictures are held against, is of the scene as it was.
TEST(StagedEdits, FramesAndReferencesOfBeforeAreForgotten) {
    ViewState state = small_state();
    Painter painter, fresh;
    for (const char* frame : {"frame 1", "frame 2", "frame 1"}) {
        act(state, frame);
        painted(painter, request_of(state, false));
    }
    act(state, "edit media/haze/extinction 0.7");
    painted(painter, request_of(state, false));
    EXPECT_EQ(painter.store.size(), 0u);
    act(state, "frame 2");
    EXPECT_EQ(painted(painter, request_of(state, false)), painted(fresh, request_of(state, false)));

    act(state, "show error");
    painted(painter, request_of(state, false));
    EXPECT_GT(painter.reference.rounds.rounds, 0);
    act(state, "edit media/haze/extinction 0.1");
    const auto first = paint(painter, request_of(state, false), never_cancelled);
    EXPECT_FALSE(first->reference);
}
}
