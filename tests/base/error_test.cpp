#include "base/text.h"
#include "base/utf8.h"
#include "support/expect.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
TEST(Printable, KeepsOrdinaryTextToTheLastByte) {
    EXPECT_EQ(printable("fog \xc3\xa4\xe2\x82\xac\xf0\x9f\x8c\xab"), "fog \xc3\xa4\xe2\x82\xac\xf0\x9f\x8c\xab");
    EXPECT_EQ(printable(std::string(200, 'x')), std::string(200, 'x'));
    EXPECT_EQ(printable(std::string(201, 'x')), std::string(197, 'x') + "...");
    EXPECT_EQ(printable("", 0), "");
}

TEST(Printable, SpellsOutWhatATerminalWouldActOn) {
    EXPECT_EQ(printable("a\nb\x1b[2J\x7f"), "a\\x0ab\\x1b[2J\\x7f");
    EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
    EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");                            // C1 control
    EXPECT_EQ(printable("\xff\xc3(\xe2\x82"), "\\xff\\xc3(\\xe2\\x82");        // malformed
    EXPECT_EQ(printable("\xed\xa0\x80\xc0\x80"), "\\xed\\xa0\\x80\\xc0\\x80"); // surrogate, overlong
}

TEST(Printable, NeverGrowsBeyondItsLimitNorTearsACharacter) {
    for (const std::string& piece :
         {std::string("\x01"), std::string("x"), std::string("\xe2\x82\xac"), std::string("\xff")}) {
        std::string text;
        while (text.size() < 300) text += piece;
        for (size_t most = 3; most < 60; ++most) {
            const std::string cut = printable(text, most);
            EXPECT_LE(cut.size(), most);
            EXPECT_TRUE(cut.ends_with("..."));
            for (std::string_view rest = cut; !rest.empty(); rest.remove_prefix(utf8_length(rest)))
                ASSERT_GT(utf8_length(rest), 0u);
        }
    }
}

TEST(Error, SaysWhereAndWhat) {
    EXPECT_STREQ(Error(ExitCode::refused, "a.json: /g", "is wrong").what(), "a.json: /g: is wrong");
    EXPECT_STREQ(Error(ExitCode::usage, "", "is wrong").what(), "is wrong");
    EXPECT_EQ(error_message(ExitCode::refused, [] { refuse("a", "b"); }), "a: b");
    EXPECT_EQ(error_message(ExitCode::unwritable, [] { fail(ExitCode::unwritable, "a", "b"); }), "a: b");
}

TEST(Error, AGarbageMessageOfMegabytesStaysOneShortLine) {
    std::string garbage;
    for (int i = 0; i < 1 << 22; ++i) garbage += static_cast<char>(i * 7);
    const std::string text = error_message(ExitCode::refused, [&] { refuse(garbage, garbage); });
    EXPECT_GT(text.size(), 400u);
}

TEST(Error, ALongPlaceKeepsTheFileInFrontAndTheFieldBehind) {
    const std::string where = "scene.json: /" + std::string(5000, 'k') + "/lights/0/type";
    const std::string text = Error(ExitCode::refused, where, "is wrong").what();
    EXPECT_TRUE(text.starts_with("scene.json: /kkk"));
    EXPECT_TRUE(text.ends_with("kkk/lights/0/type: is wrong"));
    EXPECT_LE(text.size(), 240u);
}

TEST(Utf8, LengthOfTheFirstCharacter) {
    EXPECT_EQ(utf8_length(""), 0u);
    EXPECT_EQ(utf8_length("ab"), 1u);
    EXPECT_EQ(utf8_length("\xc3\xa4x"), 2u);
    EXPECT_EQ(utf8_length("\xef\xbb\xbf"), 3u);
    EXPECT_EQ(utf8_length("\xf4\x8f\xbf\xbf"), 4u);
    for (const char* wrong : {"\x80", "\xc1\x81", "\xe0\x80\x80", "\xed\xa0\x80", "\xf0\x80\x80\x80",
                              "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xc3", "\xe2\x82"})
        EXPECT_EQ(utf8_length(wrong), 0u);
}
}
}
