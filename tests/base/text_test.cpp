// Words for people: names that are not known, and long lines.
#include "base/error.h"
#include "base/text.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tyndall {
namespace {
const std::vector<std::string> modes{"march", "froxel", "shadow-map", "shadow-volume", "path"};

TEST(Text, AMistypedNameIsAnsweredWithTheNearestOnes) {
    EXPECT_EQ(unknown_name("mode", "marhc", modes), "no mode 'marhc'; did you mean march?");
    EXPECT_EQ(unknown_name("mode", "shadow_map", modes), "no mode 'shadow_map'; did you mean shadow-map?");
    EXPECT_EQ(unknown_name("key", "ab", {"ac", "ad", "xy"}), "no key 'ab'; did you mean ac or ad?");
}

TEST(Text, ANameLikeNoOtherIsAnsweredWithWhatThereIsWhereTheListIsShort) {
    EXPECT_EQ(unknown_name("mode", "raster", modes),
              "no mode 'raster'; available: march, froxel, shadow-map, shadow-volume, path");
    EXPECT_EQ(unknown_name("camera", "main", {}), "no camera 'main'; none exist");
    EXPECT_EQ(unknown_name("row", "zzzz", std::vector<std::string>(100, "march.step_depth")), "no row 'zzzz'");
    EXPECT_EQ(unknown_name("mode", "\x1b[2J", {}), "no mode '\\x1b[2J'; none exist");
}

TEST(Text, LongLinesAreBrokenAtSpaces) {
    EXPECT_EQ(wrapped("one two three", 7, 2), "one two\n  three");
    EXPECT_EQ(wrapped("short", 7, 2), "short");
    EXPECT_EQ(wrapped("unbreakable", 3, 2), "unbreakable");
}

TEST(Text, EveryExitCodeHasOneMeaning) {
    const auto table = exit_codes();
    for (const ExitCodeMeaning& row : table) EXPECT_FALSE(row.meaning.empty());
    for (const ExitCode code : {ExitCode::ok, ExitCode::differs, ExitCode::usage, ExitCode::refused,
                                ExitCode::unreadable, ExitCode::unwritable, ExitCode::non_finite,
                                ExitCode::out_of_memory, ExitCode::no_display, ExitCode::internal, ExitCode::stopped})
        EXPECT_EQ(std::ranges::count(table, code, &ExitCodeMeaning::code), 1);
}
}
}
