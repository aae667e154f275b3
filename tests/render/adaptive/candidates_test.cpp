// Ladders hold what charts and plans compare.
#include "modes/mode.h"
#include "render/adaptive/candidates.h"

#include <gtest/gtest.h>

#include <set>

namespace tyndall::test {
namespace {
std::string rows_of(const Settings& settings) {
    std::string text;
    for (const SettingRow& row : setting_rows()) text += row.name + "=" + row.get(settings) + "\n";
    return text;
}

TEST(Ladders, EveryModeHasSixDifferentRungsOrMoreWithEverMoreSamples) {
    for (const Mode& mode : modes()) {
        const std::vector<Candidate> ladder = ladder_of(mode, Settings{});
        EXPECT_GE(ladder.size(), 6u) << mode.name;
        std::set<std::string> different;
        int samples = 1;
        for (const Candidate& rung : ladder) {
            different.insert(rows_of(rung.settings));
            EXPECT_GE(rung.settings.pixel.samples, samples) << mode.name << " " << rung.name;
            samples = rung.settings.pixel.samples;
        }
        EXPECT_EQ(different.size(), ladder.size()) << mode.name;
    }
}

TEST(Ladders, LeaveAloneWhatIsNotAboutCare) {
    Settings settings;
    settings.terms.ambient = false, settings.path.orders = 3, settings.style.density = 2;
    for (const Mode& mode : modes())
        for (const Candidate& rung : ladder_of(mode, settings)) {
            EXPECT_FALSE(rung.settings.terms.ambient) << mode.name;
            EXPECT_EQ(rung.settings.path.orders, 3) << mode.name;
            EXPECT_EQ(rung.settings.style.density, 2) << mode.name;
        }
}
}
}
