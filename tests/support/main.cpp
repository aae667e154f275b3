// The main function of the test programs. `test_render goal` runs the tests of tests/render/goal_test.cpp, but for the
// nightly ones, in one process: starting one takes longer than most tests do. Else Google Test's own options hold.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace {
// Google Test's filter for the tests of a file; empty when there are none.
std::string tests_of(const std::string& file) {
    std::string filter;
    const testing::UnitTest& all = *testing::UnitTest::GetInstance();
    for (int s = 0; s < all.total_test_suite_count(); ++s) {
        const testing::TestSuite& suite = *all.GetTestSuite(s);
        for (int t = 0; t < suite.total_test_count(); ++t) {
            const testing::TestInfo& test = *suite.GetTestInfo(t);
            const std::string name = std::string(suite.name()) + "." + test.name();
            const bool nightly = name.find("Nightly") != std::string::npos;
            if (!nightly && std::filesystem::path(test.file()).stem() == file) filter += name + ":";
        }
    }
    return filter;
}
}

int main(int count, char** arguments) {
    testing::InitGoogleTest(&count, arguments);
    if (count > 1) {
        const std::string filter = tests_of(std::string(arguments[1]) + "_test");
        if (filter.empty()) {
            std::fprintf(stderr, "%s: no tests in %s_test.cpp\n", arguments[0], arguments[1]);
            return 2;
        }
        GTEST_FLAG_SET(filter, filter);
    }
    return RUN_ALL_TESTS();
}
