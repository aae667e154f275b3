// What modes say of themselves: alike is said once, with the worst numbers.
#include "modes/limitation.h"

#include "base/json/json.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr LimitationKind blurred{"blurred", "blurred over {} m in {n} places"}, dark{"dark", "is dark"};

TEST(Limitations, AlikeAreOneGroupWithTheWorstNumbers) {
    Limitations said;
    for (int i = 0; i < 12; ++i)
        said.push_back({Severity::degraded,
                        &blurred,
                        Subject::light,
                        std::string(1, static_cast<char>('a' + i)),
                        {i == 5 ? 20.0 : 0.1234, 4}});
    said.push_back({Severity::info, &blurred, Subject::light, "z", {1, 1}});
    said.push_back({Severity::wrong, &dark, Subject::medium, "dust"});
    said.push_back({Severity::wrong, &dark, Subject::medium, "smoke"});
    const std::vector<LimitationGroup> groups = groups_of(said);
    ASSERT_EQ(groups.size(), 3u);
    EXPECT_EQ(line_of(groups[0]), "degraded: 12 lights (a, b, c, ...): blurred over 20 m in 4 places (blurred)");
    EXPECT_EQ(line_of(groups[1]), "info: light z: blurred over 1 m in 1 places (blurred)");
    EXPECT_EQ(line_of(groups[2]), "wrong: 2 media (dust, smoke): is dark (dark)");
}

TEST(Limitations, AmountsHaveTwoDigitsAndNoExponent) {
    const auto said = [](double amount) {
        Limitations one;
        one.push_back({Severity::info, &blurred, Subject::light, "z", {amount, 1}});
        return line_of(groups_of(one)[0]);
    };
    EXPECT_EQ(said(0.01234), "info: light z: blurred over 0.012 m in 1 places (blurred)");
    EXPECT_EQ(said(99.4), "info: light z: blurred over 99 m in 1 places (blurred)");
    EXPECT_EQ(said(99.6), "info: light z: blurred over 100 m in 1 places (blurred)");
    EXPECT_EQ(said(163), "info: light z: blurred over 160 m in 1 places (blurred)");
    EXPECT_EQ(said(-123456), "info: light z: blurred over -120000 m in 1 places (blurred)");
}

TEST(Limitations, WhereIsWordAndName) {
    EXPECT_EQ(where_of(Limitation{Severity::info, &dark, Subject::medium, "medium 1"}), "medium 1");
    EXPECT_EQ(where_of(Limitation{Severity::info, &dark, Subject::medium, "mediumistic"}), "medium mediumistic");
    EXPECT_EQ(where_of(Limitation{Severity::info, &dark, Subject::camera}), "camera");
    EXPECT_EQ(where_of(Limitation{Severity::info, &dark, Subject::camera, "camera"}), "camera");
    EXPECT_EQ(where_of(Limitation{Severity::info, &dark, Subject::setting, "froxel.tile"}), "froxel.tile");
    const std::string broken =
        where_of(Limitation{Severity::info, &dark, Subject::light, "a\nb" + std::string(500, 'x')});
    EXPECT_EQ(broken.find('\n'), std::string::npos);
    EXPECT_LT(broken.size(), 120u);
}

TEST(Limitations, JsonHasAnEntryForEachGroup) {
    const Json json = json_of({{Severity::degraded, &blurred, Subject::light, "sun", {0.5, 3}},
                               {Severity::degraded, &blurred, Subject::light, "lamp", {2, 4}},
                               {Severity::degraded, &dark, Subject::camera}});
    ASSERT_EQ(json.items.size(), 2u);
    EXPECT_EQ(json.items[0].string_or("severity", ""), "degraded");
    EXPECT_EQ(json.items[0].string_or("id", ""), "blurred");
    EXPECT_EQ(json.items[0].string_or("where", ""), "2 lights (sun, lamp)");
    EXPECT_EQ(json.items[0].string_or("why", ""), "blurred over 2 m in 4 places");
    EXPECT_EQ(format_json(*json.items[0].find("names")), "[\"sun\",\"lamp\"]");
    EXPECT_EQ(format_json(*json.items[0].find("amounts")), "[2,4]");
    EXPECT_EQ(json.items[1].string_or("where", ""), "camera");
}
}
}
