#include "base/json/json.h"
#include "support/expect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <random>

namespace tyndall {
namespace {
using testing::HasSubstr;

std::string refusal(const std::string& text) {
    return error_message(ExitCode::refused, [&] { parse_json(text, "a.json"); });
}

TEST(JsonParse, ReadsEveryKindOfValueInOrder) {
    const Json json =
        parse_json(R"({"b": [1, -2.5, 1e3, true, null], "a": {"text": "fog \u00e4 \ud83c\udf2b"}})", "a.json");
    ASSERT_EQ(json.kind, Json::Kind::object);
    ASSERT_EQ(json.members.size(), 2u);
    EXPECT_EQ(json.members[0].first, "b");
    const auto& items = json.members[0].second.items;
    ASSERT_EQ(items.size(), 5u);
    EXPECT_EQ(items[1].number, -2.5);
    EXPECT_EQ(items[2].number, 1000);
    EXPECT_TRUE(items[3].boolean);
    EXPECT_EQ(items[4].kind, Json::Kind::null);
    EXPECT_EQ(json.find("a")->string_or("text", ""), "fog \xc3\xa4 \xf0\x9f\x8c\xab");
    EXPECT_EQ(parse_json("7", "a.json").number, 7);
}

TEST(JsonParse, MembersOrWhatStandsForThem) {
    const Json json = parse_json(R"({"n": 2, "yes": true, "s": "x"})", "a.json");
    EXPECT_EQ(json.number_or("n", 5), 2);
    EXPECT_EQ(json.number_or("absent", 5), 5);
    EXPECT_TRUE(json.boolean_or("yes", false));
    EXPECT_TRUE(json.boolean_or("absent", true));
    EXPECT_EQ(json.string_or("s", "y"), "x");
    EXPECT_EQ(json.string_or("absent", "y"), "y");
    EXPECT_TRUE(json.has("n"));
    EXPECT_FALSE(json.has("N"));
    EXPECT_EQ(json.find("absent"), nullptr);
}

TEST(JsonParse, TakesCommentsAndAByteOrderMark) {
    EXPECT_EQ(parse_json("\xef\xbb\xbf// fog\n[1, /* two */ 2]\n// end", "a.json").items.size(), 2u);
}

TEST(JsonParse, ExtremeNumbersAreExact) {
    const Json json =
        parse_json("[1.7976931348623157e308, 4.9406564584124654e-324, 9007199254740992, -0.0, 1e-400]", "a.json");
    EXPECT_EQ(json.items[0].number, DBL_MAX);
    EXPECT_EQ(json.items[1].number, 4.9406564584124654e-324);
    EXPECT_EQ(json.items[2].number, 0x1p53);
    EXPECT_TRUE(std::signbit(json.items[3].number));
    EXPECT_EQ(json.items[4].number, 0);
}

TEST(JsonParse, NamesLineAndColumn) {
    EXPECT_THAT(refusal(""), HasSubstr("a.json: line 1, column 1: "));
    EXPECT_THAT(refusal("{\n  \"a\": 1,\n  \"b\" 2\n}"), HasSubstr("a.json: line 3, column 7: "));
    EXPECT_THAT(refusal("[1,\n2,\n]"), HasSubstr("line 3, column 1: "));
    EXPECT_THAT(refusal("\xef\xbb\xbf[x]"), HasSubstr("line 1, column 2: "));
    EXPECT_THAT(refusal("[\"\xc3\xa4\xc3\xa4\" x]"), HasSubstr("line 1, column 7: "));
    EXPECT_THAT(refusal("[1, 2] 3"), HasSubstr("line 1, column 8: "));
    EXPECT_THAT(refusal("{\"a\": 1"), HasSubstr("end of input"));
}

TEST(JsonParse, RefusesWhatIsNotJson) {
    for (const char* text : {"{",
                             "[",
                             "]",
                             "\"",
                             "{\"a\"}",
                             "{a: 1}",
                             "{'a': 1}",
                             "[1,]",
                             "{\"a\":1,}",
                             "[01]",
                             "[+1]",
                             "[.5]",
                             "[1.]",
                             "[1e]",
                             "[0x10]",
                             "[NaN]",
                             "[Infinity]",
                             "[-]",
                             "nul",
                             "[1 2]",
                             "\"\t\"",
                             "\"\\x41\"",
                             "\"\\ud800\"",
                             "\"\\ud800\\u0041\"",
                             "\"\xff\"",
                             "\"\xc0\x80\"",
                             "\"\xed\xa0\x80\"",
                             "/* open",
                             "[1]/",
                             "# no comment\n1",
                             "1 1",
                             "\xff\xfe[\x00 1]"}) {
        SCOPED_TRACE(text);
        EXPECT_THAT(refusal(text), HasSubstr("a.json: line "));
    }
}

TEST(JsonParse, RefusesNumbersBeyondDouble) {
    EXPECT_THAT(refusal("{\"a\": 1e400}"), HasSubstr("line 1, column 11: number overflow parsing '1e400'"));
    EXPECT_THAT(refusal("[-1e999]"), HasSubstr("overflow"));
    EXPECT_THAT(refusal("[" + std::string(400, '9') + "]"), HasSubstr("overflow"));
}

TEST(JsonParse, RefusesAKeyThatIsThereTwice) {
    EXPECT_THAT(refusal(R"({"a": 1, "a": 2})"), HasSubstr("a.json: /a: the key appears twice"));
    EXPECT_THAT(refusal(R"({"l": [{}, {"x/y": 1, "b": {"a": 0}, "x\/y": 2}]})"),
                HasSubstr("a.json: /l/1/x~1y: the key appears twice"));
    EXPECT_NO_THROW(parse_json(R"({"a": {"a": 1}, "b": {"a": [{"a": 1}, {"a": 2}]}})", "a.json"));
}

TEST(JsonParse, DepthEndsAt64) {
    const auto nested = [](size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
    EXPECT_NO_THROW(parse_json(nested(64), "a.json"));
    EXPECT_THAT(refusal(nested(65)), HasSubstr("nested deeper than 64 levels"));
    EXPECT_THAT(refusal(std::string(5000000, '[')), HasSubstr("nested deeper than 64 levels"));
    std::string objects;
    for (int i = 0; i < 100; ++i) objects += "{\"k\":";
    EXPECT_THAT(refusal(objects), HasSubstr("a.json: /k/k/k/"));
}

TEST(JsonParse, RefusesZeroBytesInStrings) {
    EXPECT_THAT(refusal(R"({"file": "a.vdb\u0000.txt"})"), HasSubstr("a.json: /file: the string contains a zero byte"));
    EXPECT_THAT(refusal(R"({"a\u0000": 1})"), HasSubstr("a key contains a zero byte"));
    EXPECT_THAT(refusal(std::string("[\0]", 3)), HasSubstr("line 1, column 2: "));
}

TEST(JsonParse, RefusesFloodsOfValues) {
    std::string text = "[0";
    for (int i = 0; i < 1 << 20; ++i) text += ",0";
    EXPECT_THAT(refusal(text + "]"), HasSubstr("more than 1048576 JSON values"));
}

TEST(JsonFormat, ShortestFormThatReadsBackTheSame) {
    const char* const text = R"({"a":[1,-2.5,1e+22,0.1,true,false,null,"x"],"empty":{},"none":[]})";
    EXPECT_EQ(format_json(parse_json(text, "a.json")), text);
    EXPECT_EQ(format_json(Json{}), "null");
}

TEST(JsonFormat, RandomNumbersComeBackToTheBit) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20000; ++i) {
        Json value;
        value.kind = Json::Kind::number;
        value.number = std::bit_cast<double>(random());
        if (!std::isfinite(value.number)) continue;
        EXPECT_EQ(parse_json(format_json(value), "a.json").number, value.number);
    }
}

TEST(JsonFormat, QuotesEveryString) {
    EXPECT_EQ(quote_json("a\"b\\c\n\t\x01\x7f/"), R"("a\"b\\c\n\u0009\u0001\u007f/")");
    EXPECT_EQ(quote_json("\xc3\xa4\xff\xf0\x9f\x8c\xab"), "\"\xc3\xa4\\ufffd\xf0\x9f\x8c\xab\"");
    std::string every;
    for (int c = 1; c < 128; ++c) every += static_cast<char>(c);
    EXPECT_EQ(parse_json(quote_json(every), "a.json").string, every);
}

// Whatever the bytes, the parser ends with a tree or with one line; a tree that it accepts comes back from its own
// text.
TEST(JsonParse, RandomDamageIsReadOrRefused) {
    const std::string whole =
        R"({"lights": [{"type": "spot", "at": [0.5, -1e3, 2], "on": true, "name": "\u00e4 \"x\""}, null], "n": {}})";
    std::mt19937 random(11);
    int read = 0, refused = 0;
    for (int round = 0; round < 10000; ++round) {
        std::string text = whole;
        for (unsigned edits = 1 + random() % 3; edits > 0 && !text.empty(); --edits) {
            const size_t at = random() % text.size();
            switch (random() % 4) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text.erase(at, 1 + random() % 5);
                break;
            case 2:
                text.insert(at, std::string(1 + random() % 3, "[]{}\",:0e-\\/"[random() % 12]));
                break;
            default:
                text.resize(at + 1);
            }
        }
        try {
            const Json json = parse_json(text, "a.json");
            EXPECT_EQ(format_json(parse_json(format_json(json), "a.json")), format_json(json));
            ++read;
        } catch (const Error& error) {
            ASSERT_EQ(error.code, ExitCode::refused);
            ASSERT_LE(std::string(error.what()).size(), 500u);
            ++refused;
        }
    }
    EXPECT_GT(read, 250);
    EXPECT_GT(refused, 2500);
}
}
}
