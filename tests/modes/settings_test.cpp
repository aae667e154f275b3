#include "modes/mode.h"
#include "support/expect.h"

#include "base/error.h"
#include "modes/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace tyndall {
namespace {
std::string refusal(std::string_view assignment) {
    Settings settings;
    return error_message(ExitCode::usage, [&] { apply_setting(settings, assignment); });
}

TEST(Settings, EveryRowReadsBackWhatWasSet) {
    std::set<std::string> names;
    for (const SettingRow& row : setting_rows()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_FALSE(row.doc.empty()) << row.name;
        std::vector<std::string> values = row.choices;
        if (values.empty()) values = {row.integer ? std::to_string(static_cast<int>(row.low)) : "0.25"};
        if (row.parts == 3) values = {"0.25,0.5,1"};
        for (const std::string& value : values) {
            Settings settings;
            apply_setting(settings, row.name + "=" + value);
            EXPECT_EQ(row.get(settings), value) << row.name;
        }
    }
}

TEST(Settings, EveryQualityIsWithinTheRows) {
    for (const Quality quality : {Quality::draft, Quality::preview, Quality::final, Quality::reference}) {
        Settings settings = settings_for(quality);
        for (const SettingRow& row : setting_rows()) EXPECT_NO_THROW(row.set(settings, row.get(settings))) << row.name;
        EXPECT_EQ(quality_named(name_of(quality)), quality);
    }
}

TEST(Settings, BadAssignmentsSayWhatWouldDo) {
    EXPECT_THAT(refusal("march.step_depht=1"), testing::HasSubstr("did you mean march.step_depth?"));
    EXPECT_THAT(refusal("march.step_depth=-1"),
                testing::HasSubstr("march.step_depth: expected a number from 1e-04 to 10"));
    EXPECT_THAT(refusal("march.step_depth=nan"), testing::HasSubstr("got 'nan'"));
    EXPECT_THAT(refusal("march.nodes=1.5"), testing::HasSubstr("whole number"));
    EXPECT_THAT(refusal("terms.light=gird"), testing::HasSubstr("did you mean grid?"));
    EXPECT_THAT(refusal("terms.light"), testing::HasSubstr("row=value"));
    EXPECT_THAT(refusal("march.step_depth="), testing::HasSubstr("got ''"));
}

TEST(Modes, TheTableFindsEachModeAndNamesThemAll) {
    for (const Mode& mode : modes()) {
        EXPECT_EQ(&find_mode(mode.name), &mode);
        EXPECT_FALSE(mode.summary.empty());
    }
    EXPECT_THAT(error_message(ExitCode::usage, [] { find_mode("marhc"); }), testing::HasSubstr("march"));
}
}
}
