#include "base/io/frames.h"
#include "support/expect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <climits>
#include <random>

namespace tyndall {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;

struct Legal {
    const char* text;
    std::vector<int> frames;
};

const Legal legal_ranges[] = {{"7", {7}},
                              {"-3", {-3}},
                              {"0", {0}},
                              {"-0", {0}},
                              {"007", {7}},
                              {"1-3", {1, 2, 3}},
                              {"5-5", {5}},
                              {"-3-4", {-3, -2, -1, 0, 1, 2, 3, 4}},
                              {"-5--2", {-5, -4, -3, -2}},
                              {"1-10x3", {1, 4, 7, 10}},
                              {"1-9x3", {1, 4, 7}},
                              {"1-9:3,10", {1, 4, 7, 10}},
                              {"1-2x100", {1}},
                              {"5-5x-1", {5}},
                              {"4-1x-1", {4, 3, 2, 1}},
                              {"10-1x-4", {10, 6, 2}},
                              {"-1--3x-1", {-1, -2, -3}},
                              {"1,5,9", {1, 5, 9}},
                              {"9,1,5", {9, 1, 5}},
                              {"1,1,1", {1}},
                              {"3-5,1-4", {3, 4, 5, 1, 2}},
                              {"1-5x2,2-4x2", {1, 3, 5, 2, 4}},
                              {"2147483647", {INT_MAX}},
                              {"-2147483648", {INT_MIN}},
                              {"2147483645-2147483647", {INT_MAX - 2, INT_MAX - 1, INT_MAX}},
                              {"-2147483648-2147483647x2147483647", {INT_MIN, -1, INT_MAX - 1}}};

TEST(Frames, LegalRangesExpand) {
    for (const auto& [text, frames] : legal_ranges) EXPECT_EQ(parse_frames(text), frames) << text;
}

struct Illegal {
    const char *text, *complaint;
};

const Illegal illegal_ranges[] = {{"", "column 1: expected a frame number"},
                                  {"a", "column 1: expected a frame number"},
                                  {" 1", "column 1: expected a frame number"},
                                  {"1 ", "column 2: unexpected ' '"},
                                  {"1,", "column 3: expected a frame number"},
                                  {",1", "column 1: expected a frame number"},
                                  {"1,,2", "column 3: expected a frame number"},
                                  {"1-", "column 3: expected a frame number"},
                                  {"--1", "column 2: expected a frame number"},
                                  {"+1", "column 1: expected a frame number"},
                                  {"1-5x", "column 5: expected a step"},
                                  {"1-5x0", "column 5: the step must not be 0"},
                                  {"1-5x-1", "column 5: the step leads away"},
                                  {"5-1x1", "column 5: the step leads away"},
                                  {"5-1", "column 1: the range runs backwards; count down with 5-1x-1"},
                                  {"2,5--1", "column 3: the range runs backwards; count down with 5--1x-1"},
                                  {"1:5", "column 2: expected FIRST-LAST before the step"},
                                  {"1-10:0", "column 6: the step must not be 0"},
                                  {"1-10y2", "column 5: unexpected 'y'"},
                                  {"1-10x2x2", "column 7: unexpected 'x'"},
                                  {"1x2", "column 2: unexpected 'x'"},
                                  {"1.5", "column 2: unexpected '.'"},
                                  {"1..5", "column 2: unexpected '.'"},
                                  {"1-2-3", "column 4: unexpected '-'"},
                                  {"0x10", "column 2: unexpected 'x'"},
                                  {"2147483648", "column 1: a frame number is too large"},
                                  {"1-99999999999999999999", "column 3: a frame number is too large"},
                                  {"1-2x99999999999", "column 5: a step is too large"},
                                  {"1-1000001", "column 1: more than 1000000 frames"},
                                  {"7,-2147483648-2147483647", "column 3: more than 1000000 frames"},
                                  {"1-600000,1-600000", "column 10: more than 1000000 frames"}};

TEST(Frames, IllegalRangesAreRefusedAtTheirColumn) {
    for (const auto& [text, complaint] : illegal_ranges)
        EXPECT_THAT(error_message(ExitCode::usage, [&, range = text] { parse_frames(range); }), HasSubstr(complaint))
            << text;
}

TEST(Frames, AMillionIsTheLimit) {
    const auto frames = parse_frames("1-1000000");
    EXPECT_EQ(frames.size(), 1000000u);
    EXPECT_EQ(format_frames(frames), "1-1000000");
}

TEST(Frames, ForeignBytesInTheComplaintAreHarmless) {
    EXPECT_THAT(error_message(ExitCode::usage, [] { parse_frames("1\x1b[31m"); }), HasSubstr("unexpected '\\x1b'"));
    error_message(ExitCode::usage, [] { parse_frames(std::string(100000, 'x')); });
}

TEST(Frames, ShortestSpelling) {
    const auto spelled = [](std::vector<int> frames) { return format_frames(frames); };
    EXPECT_EQ(spelled({}), "");
    EXPECT_EQ(spelled({4}), "4");
    EXPECT_EQ(spelled({1, 2, 3}), "1-3");
    EXPECT_EQ(spelled({1, 3, 5, 7, 9, 20}), "1-9x2,20");
    EXPECT_EQ(spelled({1, 3, 5, 6, 7, 8}), "1,3,5-8");
    EXPECT_EQ(spelled({10, 9, 8, 7}), "10-7x-1");
    EXPECT_EQ(spelled({-3, -2, -1}), "-3--1");
    EXPECT_EQ(spelled({7, 3, 100}), "7,3,100");
    EXPECT_EQ(spelled({INT_MIN, INT_MAX}), "-2147483648,2147483647");
}

// Least length over every way to cut the list into single frames and even runs.
size_t min_length(const std::vector<int>& frames) {
    const auto length = [](int64_t value) { return std::to_string(value).size(); };
    std::vector<size_t> best(frames.size() + 1, SIZE_MAX);
    best[0] = 0;
    for (size_t end = 1; end <= frames.size(); ++end) {
        for (size_t start = end; start-- > 0;) {
            const int64_t step = start + 1 < end ? int64_t{frames[start + 1]} - frames[start] : 1;
            if (start + 2 < end && int64_t{frames[start + 2]} - frames[start + 1] != step) break;
            size_t piece = length(frames[start]) + 1;
            if (start + 1 < end) piece += 1 + length(frames[end - 1]) + (step == 1 ? 0 : 1 + length(step));
            best[end] = std::min(best[end], best[start] + piece);
        }
    }
    return best.back() - 1;
}

TEST(Frames, RandomListsComeBackFromAShortestSpelling) {
    std::mt19937 random(7);
    for (int round = 0; round < 2000; ++round) {
        std::vector<int> frames;
        int frame = static_cast<int>(random() % 200) - 100;
        while (frames.size() < 1u + static_cast<size_t>(round) % 12) {
            if (std::find(frames.begin(), frames.end(), frame) == frames.end()) frames.push_back(frame);
            static const int steps[] = {1, 1, 1, 2, 2, -1, 13, -40};
            frame += steps[random() % 8];
        }
        const std::string text = format_frames(frames);
        EXPECT_EQ(parse_frames(text), frames) << text;
        EXPECT_EQ(text.size(), min_length(frames)) << text;
    }
}

TEST(FramePattern, EverySpelling) {
    EXPECT_EQ(frame_name("a.####.exr", 12), "a.0012.exr");
    EXPECT_EQ(frame_name("a.##.exr", 7), "a.07.exr");
    EXPECT_EQ(frame_name("a.#.exr", 7), "a.0007.exr");
    EXPECT_EQ(frame_name("a.%04d.exr", 12), "a.0012.exr");
    EXPECT_EQ(frame_name("a.%d.exr", 12), "a.12.exr");
    EXPECT_EQ(frame_name("a.%012d.exr", 12), "a.000000000012.exr");
    EXPECT_EQ(frame_name("a.$F.exr", 12), "a.12.exr");
    EXPECT_EQ(frame_name("a.$F4.exr", 12), "a.0012.exr");
    EXPECT_EQ(frame_name("$F4", 1), "0001");
    EXPECT_EQ(frame_name("##/a.exr", 3), "03/a.exr");
    EXPECT_EQ(frame_name("a.@@@@.exr", 12), "a.0012.exr");
    EXPECT_EQ(frame_name("me@home/a.@@.exr", 12), "me@home/a.12.exr");
    EXPECT_EQ(frame_name("a.<F4>.exr", 12), "a.0012.exr");
    EXPECT_EQ(frame_name("<F>.exr", 12), "12.exr");
}

TEST(FramePattern, SignsAndLongNumbersAreKept) {
    EXPECT_EQ(frame_name("####", -3), "-0003");
    EXPECT_EQ(frame_name("%04d", -3), "-0003");
    EXPECT_EQ(frame_name("$F", -3), "-3");
    EXPECT_EQ(frame_name("##", 12345), "12345");
    EXPECT_EQ(frame_name("##", INT_MIN), "-2147483648");
}

TEST(Frames, SpreadLeavesNoGapLongerThanTheOneBefore) {
    EXPECT_EQ(spread_frames({}), std::vector<int>());
    EXPECT_EQ(spread_frames({7}), std::vector<int>{7});
    EXPECT_EQ(spread_frames(frames_between(1, 9)), (std::vector<int>{1, 9, 5, 3, 7, 2, 4, 6, 8}));
    EXPECT_EQ(spread_frames({40, 10, 30}), (std::vector<int>{40, 30, 10}));
    for (const int count : {2, 3, 10, 97, 100}) {
        std::vector<int> frames = spread_frames(frames_between(1001, 1000 + count));
        std::ranges::sort(frames);
        EXPECT_EQ(frames, frames_between(1001, 1000 + count));
    }
}

TEST(FramePattern, WithoutAToken) {
    for (const char* pattern :
         {"a.exr", "", "a@.exr", "$HOME/a.exr", "$FPS.exr", "$Fold.exr", "$", "<UDIM>", "<F4", "<Fx>", "a<"}) {
        EXPECT_FALSE(has_frame_token(pattern)) << pattern;
        EXPECT_EQ(frame_name(pattern, 5), pattern);
    }
    for (const char* pattern : {"#", "##", "%d", "%02d", "$F", "$F3", "$FPS.$F.exr"})
        EXPECT_TRUE(has_frame_token(pattern)) << pattern;
}

TEST(FramePattern, AnythingThatPrintfMightTakeOtherwiseIsRefused) {
    for (const char* pattern : {"a.%s.exr", "a.%n", "%", "a%%b", "%4d", "%0d", "%00d", "%ld", "%x", "%+d", "%-4d",
                                "%04", "%1$d", "%*d", "50% fog.exr"})
        EXPECT_THAT(error_message(ExitCode::usage, [&] { has_frame_token(pattern); }), HasSubstr("only %d and %04d"))
            << pattern;
    for (const char* pattern : {"####.##", "%04d.####", "$F.$F", "$F4_%d", "#/#", "@@.@@", "<F>#"})
        EXPECT_THAT(error_message(ExitCode::usage, [&] { frame_name(pattern, 1); }),
                    HasSubstr("already has a frame number"))
            << pattern;
    for (const char* pattern : {"#############", "%013d", "$F13", "@@@@@@@@@@@@@", "<F13>", "%099999999999999999999d"})
        EXPECT_THAT(error_message(ExitCode::usage, [&] { frame_name(pattern, 1); }), HasSubstr("at most 12 digits"))
            << pattern;
    EXPECT_THAT(error_message(ExitCode::usage, [] { frame_name("$F0", 1); }), HasSubstr("width from 1 to 12"));
    EXPECT_THAT(error_message(ExitCode::usage, [] { frame_name("<F0>", 1); }), HasSubstr("width from 1 to 12"));
    EXPECT_THAT(error_message(ExitCode::usage, [] { frame_name("abc%s", 1); }), HasSubstr("column 4"));
}
}
}
