// A scene's own files are no outputs, nor is any number of its sequences.
#include "scene/input_files.h"

#include "scene/scene.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using ::testing::HasSubstr;

TEST(InputFiles, NumberedInputsAreNotOverwritten) {
    const TempFolder scratch;
    for (const char* name : {"gobo.0001.exr", "gobo.0007.exr", "fog.0002.vdb", "hot.0003.vdb"}) scratch.put(name, "");
    Scene scene;
    scene.lights.emplace_back().gobo.emplace().sequence = find_sequence("gobo.####.exr", scratch.path());
    MediumSource& medium = scene.media.emplace_back();
    medium.kind = MediumKind::vdb, medium.sequence = find_sequence("fog.####.vdb", scratch.path());
    medium.sequence.offset = 5;
    medium.temperature = GridSource{find_sequence("hot.####.vdb", scratch.path()), {"hot"}, {}};
    const auto overwritten = [&](const char* name) {
        OutputPaths places;
        places.check(scratch / name);
        const Error error = error_of([&] { spare_files(scene, places); });
        return error.code == ExitCode::usage;
    };
    for (const char* name : {"gobo.0001.exr", "gobo.0007.exr", "fog.0002.vdb", "hot.0003.vdb"})
        EXPECT_TRUE(overwritten(name)) << name;
    for (const char* name : {"gobo.0002.exr", "gobo.exr", "fog.0007.vdb"}) EXPECT_FALSE(overwritten(name)) << name;
}
}
}
