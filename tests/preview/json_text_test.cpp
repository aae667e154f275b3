#include "base/error.h"
#include "base/json.h"
#include "base/random.h"
#include "preview/json_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace tyndall {
namespace {
std::string_view found(std::string_view text, std::string_view pointer) {
    const auto span = find_json(text, pointer);
    return span ? span->of(text) : "nothing";
}

constexpr std::string_view nasty = "\xef\xbb\xbf// a note with \"quotes\" and { brackets\r\n"
                                   "{ \"a\": [ 1.5e-3 , [ ] , {\"b\" :[[0,-2E+5]]} ]\t, /* , \"x\": 1 */\r\n"
                                   "  \"q\\\"uo/te~\": \"\\\\\\\"]}\",\r\n"
                                   "  \"\\u00e4\\ud83d\\ude00\" : true, \"\u00f6\":null,\r\n"
                                   "  \"\": {\"\": 7} // last\r\n"
                                   "}  \r\n";
}

TEST(JsonText, FindsTheBytesOfAValue) {
    parse_json(nasty, "nasty"); // is what the reader takes
    EXPECT_EQ(found(nasty, "/a/0"), "1.5e-3");
    EXPECT_EQ(found(nasty, "/a/1"), "[ ]");
    EXPECT_EQ(found(nasty, "/a/2/b"), "[[0,-2E+5]]");
    EXPECT_EQ(found(nasty, "/a/2/b/0/1"), "-2E+5");
    EXPECT_EQ(found(nasty, "/q\"uo~1te~0"), "\"\\\\\\\"]}\"");
    EXPECT_EQ(found(nasty, "/\u00e4\U0001f600"), "true");
    EXPECT_EQ(found(nasty, "/\u00f6"), "null");
    EXPECT_EQ(found(nasty, "/"), "{\"\": 7}");
    EXPECT_EQ(found(nasty, "//"), "7");
    EXPECT_EQ(found("  [true] ", ""), "[true]");
    EXPECT_EQ(found(" 12", ""), "12");
}

TEST(JsonText, FindsNothingWhereNothingIs) {
    for (const char* pointer : {"/x", "/a/3", "/a/-1", "/a/", "/a/0/1", "/a/2/b/0/1/0", "/a/01x", "/q"})
        EXPECT_EQ(found(nasty, pointer), "nothing") << pointer;
}

TEST(JsonText, ReplacesAValueAndNothingElse) {
    const std::string text = with_json(nasty, "/a/2/b/0/1", "3");
    const size_t place = nasty.find("-2E+5");
    EXPECT_EQ(text, std::string(nasty.substr(0, place)) + "3" + std::string(nasty.substr(place + 5)));
    EXPECT_EQ(with_json("{\"a\": 1, \"b\": [1, 2]} ", "/b", "\"x\""), "{\"a\": 1, \"b\": \"x\"} ");
}

TEST(JsonText, PutsAMemberInAsItsNeighboursAre) {
    EXPECT_EQ(with_json("{\n  \"a\": 1\n}\n", "/b", "2"), "{\n  \"a\": 1,\n  \"b\": 2\n}\n");
    EXPECT_EQ(with_json("{\r\n\t\"a\" : 1\r\n}", "/b", "2"), "{\r\n\t\"a\" : 1,\r\n\t\"b\" : 2\r\n}");
    EXPECT_EQ(with_json("{ \"a\": 1, \"b\": 2 }", "/c", "3"), "{ \"a\": 1, \"b\": 2, \"c\": 3 }");
    EXPECT_EQ(with_json("{\"a\":1,\"b\":2}", "/c", "3"), "{\"a\":1,\"b\":2,\"c\":3}");
    EXPECT_EQ(with_json("{\"a\": 1}", "/c", "3"), "{\"a\": 1, \"c\": 3}");
    EXPECT_EQ(with_json("{}", "/c", "3"), "{ \"c\": 3 }");
    EXPECT_EQ(with_json("{\n}", "/c", "3"), "{ \"c\": 3 }");
    EXPECT_EQ(with_json("{ /* none */ }", "/c", "3"), "{ \"c\": 3 /* none */ }");
    EXPECT_EQ(with_json("{\n    \"a\": 1, \"b\": 2,\n    \"c\": {\"d\": 0}\n}", "/e", "3"),
              "{\n    \"a\": 1, \"b\": 2,\n    \"c\": {\"d\": 0},\n    \"e\": 3\n}");
    EXPECT_EQ(with_json("{\"a\": 1}", "/q\"~1", "3"), "{\"a\": 1, \"q\\\"/\": 3}");
}

TEST(JsonText, CommentsStayWithTheValueTheyFollow) {
    EXPECT_EQ(with_json("{\n  \"a\": 1 // one, two\n}", "/b", "2"), "{\n  \"a\": 1, // one, two\n  \"b\": 2\n}");
    EXPECT_EQ(with_json("{ \"a\": 1 // one\n}", "/b", "2"), "{ \"a\": 1, // one\n\"b\": 2\n}");
    EXPECT_EQ(with_json("{ \"a\": 1 /* } */ }", "/b", "2"), "{ \"a\": 1, /* } */ \"b\": 2 }");
    EXPECT_EQ(with_json("{\n  \"a\": [1] // x\n  // y\n}", "/b", "2"), "{\n  \"a\": [1], // x\n  // y\n  \"b\": 2\n}");
}

TEST(JsonText, MissingParentsBecomeObjects) {
    EXPECT_EQ(with_json("{\n  \"a\": 1\n}", "/b/c/d", "2"), "{\n  \"a\": 1,\n  \"b\": { \"c\": { \"d\": 2 } }\n}");
    EXPECT_EQ(with_json("{\"a\":1}", "/b/c", "2"), "{\"a\":1,\"b\":{\"c\":2}}");
    EXPECT_THROW(with_json("{\"a\": 1}", "/a/b", "2"), Error);
    EXPECT_THROW(with_json("{\"a\": [1]}", "/a/2", "2"), Error);
}

TEST(JsonText, PutsItemsAnywhereIntoAList) {
    EXPECT_EQ(with_json_item("[[0, 1], [2, 3]]", "", 0, "[-1, 0]"), "[[-1, 0], [0, 1], [2, 3]]");
    EXPECT_EQ(with_json_item("[[0, 1], [2, 3]]", "", 1, "[1, 0]"), "[[0, 1], [1, 0], [2, 3]]");
    EXPECT_EQ(with_json_item("[[0, 1], [2, 3]]", "", 2, "[4, 0]"), "[[0, 1], [2, 3], [4, 0]]");
    EXPECT_EQ(with_json_item("{\"k\":[1,2]}", "/k", 1, "7"), "{\"k\":[1,7,2]}");
    EXPECT_EQ(with_json_item("{\"k\": []}", "/k", 0, "7"), "{\"k\": [7]}");
    EXPECT_EQ(with_json_item("[\n  1,\n  2\n]", "", 1, "7"), "[\n  1,\n  7,\n  2\n]");
    EXPECT_EQ(with_json_item("[\n  1,\n  2\n]", "", 2, "7"), "[\n  1,\n  2,\n  7\n]");
    EXPECT_EQ(with_json("{\"k\": [1]}", "/k/1", "7"), "{\"k\": [1, 7]}");
    EXPECT_THROW(with_json_item("{\"k\": 1}", "/k", 0, "7"), Error);
}

TEST(JsonText, TellsIndentationAndLineEnds) {
    EXPECT_EQ(indentation_of("{\n\t\"a\": 1}"), "\t");
    EXPECT_EQ(indentation_of("// x\n{\n   \"a\": 1}"), "   ");
    EXPECT_EQ(indentation_of("{\"a\": 1}"), "");
    EXPECT_EQ(line_end_of("{\r\n}"), "\r\n");
    EXPECT_EQ(line_end_of("{}"), "\n");
}

TEST(JsonText, BrokenTextIsRefusedNotOverrun) {
    const std::string text(nasty);
    for (size_t length = 0; length < text.size(); ++length) {
        const std::string cut = text.substr(0, length);
        for (const char* pointer : {"/a/2/b/0/1", "/", "/new"}) {
            try {
                with_json(cut, pointer, "1");
            } catch (const Error& error) {
                EXPECT_EQ(error.code, ExitCode::refused);
            }
        }
    }
}

// Every number the reader may meet: digits as short as they can be, and the same bits behind double and float.
TEST(JsonText, NumbersKeepTheirBits) {
    EXPECT_EQ(json_number(0.1f), "0.1");
    EXPECT_EQ(json_number(400), "400");
    EXPECT_EQ(json_number(100000), "100000");
    EXPECT_EQ(json_number(-2.5f), "-2.5");
    for (uint32_t i = 0; i < 200000; ++i) {
        const float value = std::bit_cast<float>(hash(i, 17u));
        if (!std::isfinite(value) || value == 0) continue;
        const float read = static_cast<float>(parse_json(json_number(value), "number").number);
        ASSERT_EQ(std::bit_cast<uint32_t>(read), std::bit_cast<uint32_t>(value)) << json_number(value);
    }
}
}
