#include "base/io/output.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using testing::HasSubstr;
using testing::IsEmpty;

TEST(OutputPaths, InputsAreNotAmongThemUnderAnyName) {
    const TempFolder scratch;
    scratch.put("sky.0002.exr", "sky");
    std::filesystem::create_directory_symlink(scratch.path(), scratch / "link");
    OutputPaths places;
    places.check((scratch / "link/sky.####.exr").string(), {1, 2});
    places.spare(scratch / "other.exr");
    for (const char* name : {"sky.0002.exr", "./sky.0002.exr", "link/sky.0002.exr"})
        EXPECT_THAT(error_message(ExitCode::usage, [&] { places.spare(scratch / name); }), HasSubstr("overwritten"));
    std::filesystem::create_symlink(scratch / "sky.0002.exr", scratch / "alias.0009.exr");
    EXPECT_THAT(error_message(ExitCode::usage,
                              [&] {
                                  places.spare_all({scratch / "alias.0008.exr", scratch / "alias.0009.exr"});
                              }),
                HasSubstr("alias.0009.exr: is read by this command and would be overwritten"));
}

TEST(OutputPaths, EmptyFoldersAreRemovedAgain) {
    const TempFolder scratch;
    { OutputPaths().check(scratch / "a/b/c.exr"); }
    EXPECT_THAT(scratch.names(), IsEmpty());
}
}
}
