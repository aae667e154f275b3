#include "viewer/fixtures.h"
#include "viewer/state/action.h"

#include <gtest/gtest.h>

namespace tyndall::test {
TEST(Script, LinesBecomeActions) {
    const auto actions = parse_script("# a look around\n\norbit 30 -5.5 # slowly\n  camera \"my camera\"\ncamera\n"
                                      "drag 10,20 30,40.5\nset march.nodes 6\r\nwait samples 4\nwait 0.5\nloop off",
                                      "a.txt");
    ASSERT_EQ(actions.size(), 8u);
    EXPECT_EQ(actions[0].verb, Verb::orbit);
    EXPECT_EQ(actions[0].numbers, (std::vector<double>{30, -5.5}));
    EXPECT_EQ(actions[0].location, "a.txt:3");
    EXPECT_EQ(actions[1].words, (std::vector<std::string>{"my camera"}));
    EXPECT_TRUE(actions[2].words.empty());
    EXPECT_EQ(actions[3].numbers, (std::vector<double>{10, 20, 30, 40.5}));
    EXPECT_EQ(actions[4].words, (std::vector<std::string>{"march.nodes", "6"}));
    EXPECT_EQ(actions[5].numbers, (std::vector<double>{4}));
    EXPECT_EQ(actions[6].words, (std::vector<std::string>{"0.5"}));
    EXPECT_EQ(actions[7].location, "a.txt:10");
}

TEST(Script, MistakesAreNamedWithFileAndLine) {
    const auto message = [](const char* text) {
        return error_message(ExitCode::refused, [&] { parse_script(text, "b.txt"); });
    };
    EXPECT_EQ(message("quit\norbt 1 2"), "b.txt:2: no action 'orbt'; did you mean orbit?");
    EXPECT_EQ(message("orbit 1"), "b.txt:1: expected orbit x y");
    EXPECT_NE(message("orbit 1 2 3").find("unexpected parameter '3'"), std::string::npos);
    EXPECT_NE(message("frame one").find("'one' is not a number"), std::string::npos);
    EXPECT_NE(message("drag 1 2").find("'1' is not a point"), std::string::npos);
    EXPECT_NE(message("loop maybe").find("expected loop on|off"), std::string::npos);
    EXPECT_NE(message("wait forever").find("not a number"), std::string::npos);
    EXPECT_NE(message("wait samples").find("wait samples N"), std::string::npos);
    EXPECT_NE(message("wait -1").find("negative"), std::string::npos);
    EXPECT_NE(message("open \"a").find("quote"), std::string::npos);
    EXPECT_NE(message("frame nan").find("not a number"), std::string::npos);
    EXPECT_NE(message("frame 1e300").find("not a number"), std::string::npos);
}

TEST(Script, EveryVerbIsListedOnce) {
    for (const VerbInfo& a : verbs())
        EXPECT_EQ(
            std::ranges::count_if(verbs(), [&](const VerbInfo& b) { return a.verb == b.verb || a.name == b.name; }), 1)
            << a.name;
    EXPECT_EQ(verbs().size(), static_cast<size_t>(Verb::quit) + 1);
}
}
