// What images of a numbered gobo lose is said, as it is of a single one.
#include "scene/images.h"
#include "scene/scene.h"
#include "support/scratch.h"
#include "trace/snapshot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(GoboSequence, NotesOnItsImagesNameTheFileOnce) {
    const TempFolder scratch;
    using Texel = std::array<uint8_t, 4>;
    scratch.put("gobo.0001.png", png_of({2, 2}, std::vector<Texel>(4, Texel{0, 0, 0, 255})));
    scratch.put("gobo.0002.png", png_of({2, 2}, std::vector<Texel>(4, Texel{255, 255, 255, 255})));
    Scene scene;
    for (const char* name : {"left", "right"}) {
        LightSource& light = scene.lights.emplace_back();
        light.name = name, light.kind = LightKind::spot, light.intensity = 1.0f;
        light.gobo.emplace().sequence = find_sequence("gobo.####.png", scratch.path());
    }
    const Snapshot black = make_snapshot(scene, Moment{1, 0});
    EXPECT_THAT(black.notes, ElementsAre("gobo.0001.png: the image is black"));
    EXPECT_THAT(make_snapshot(scene, Moment{2, 1}, &black).notes, IsEmpty());
}
}
}
