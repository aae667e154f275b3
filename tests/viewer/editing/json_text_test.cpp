#include "base/error.h"
#include "base/json/json.h"
#include "base/json/json_pointer.h"
#include "base/random.h"
#include "scene/file/scene_words.h"
#include "support/expect.h"
#include "viewer/editing/json_text.h"

#include <gtest/gtest.h>

#include <xmmintrin.h>

#include <bit>
#include <cmath>

namespace tyndall {
namespace {
std::string_view found(std::string_view text, std::string_view pointer) {
    const auto span = find_json(text, pointer);
    return span ? span->of(text) : "nothing";
}

// Documents of every shape, with white space and comments wherever they may stand.
struct Documents {
    uint32_t key, count = 0;

    uint32_t below(uint32_t limit) {
        return static_cast<uint32_t>(to_unit(hash(count++, key)) * static_cast<float>(limit));
    }
    std::string space() {
        static const std::string_view kinds[] = {
            "", "", " ", "\n", "\r\n  ", "\t", " /* , \"}] */ ", " // ] {\" \\\n", "    "};
        return std::string(kinds[below(9)]);
    }
    std::string scalar() {
        static const std::string_view kinds[] = {"0",   "-1.5e+3",    "true",   "null",          "\"\"",
                                                 "1E2", "\"a\\\"b\"", "\"//\"", "\"\\u00e4/~\"", "\"\\\\\""};
        return std::string(kinds[below(10)]);
    }
    std::string value(int depth) {
        if (depth == 0 || below(3) == 0) return scalar();
        const bool object = below(2) == 0;
        std::string text(1, object ? '{' : '[');
        const uint32_t size = below(4);
        for (uint32_t i = 0; i < size; ++i) {
            text += (i ? "," : "") + space();
            if (object) text += "\"k/" + std::to_string(i) + (i == 1 ? "\\u007e" : "") + "\"" + space() + ":" + space();
            text += value(depth - 1) + space();
        }
        return text + (size ? "" : space()) + (object ? '}' : ']');
    }
};

// Every place in a document.
void list_places(Json& value, const std::string& pointer, std::vector<std::pair<std::string, Json*>>& places) {
    places.push_back({pointer, &value});
    for (size_t i = 0; i < value.items.size(); ++i) list_places(value.items[i], json_pointer(pointer, i), places);
    for (auto& [name, member] : value.members) list_places(member, json_pointer(pointer, name), places);
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

// Whatever is replaced or put in, wherever: a parser reads the document as before, with that one change.
TEST(JsonText, AnyChangeToAnyDocumentIsThatChange) {
    for (uint32_t i = 0; i < 1500; ++i) {
        Documents random{i};
        const std::string text = random.space() + random.value(4) + random.space();
        Json tree = parse_json(text, "random");
        std::vector<std::pair<std::string, Json*>> places;
        list_places(tree, "", places);
        const auto& [pointer, place] = places[random.below(static_cast<uint32_t>(places.size()))];
        const auto span = find_json(text, pointer);
        ASSERT_TRUE(span) << pointer << "\n" << text;
        ASSERT_EQ(format_json(parse_json(span->of(text), "found")), format_json(*place)) << pointer << "\n" << text;

        const Json seven = parse_json("[7]", "new");
        std::string changed;
        if (place->kind == Json::Kind::object && random.below(2)) {
            changed = with_json(text, json_pointer(pointer, "new~/"), "[7]");
            place->members.emplace_back("new~/", seven);
        } else if (place->kind == Json::Kind::array && random.below(2)) {
            const size_t index = random.below(static_cast<uint32_t>(place->items.size()) + 1);
            changed = with_json_item(text, pointer, index, "[7]");
            place->items.insert(place->items.begin() + static_cast<std::ptrdiff_t>(index), seven);
        } else {
            changed = with_json(text, pointer, "[7]");
            EXPECT_EQ(changed, text.substr(0, span->begin) + "[7]" + text.substr(span->end));
            *place = seven;
        }
        ASSERT_EQ(format_json(parse_json(changed, "changed")), format_json(tree)) << text << "\n->\n" << changed;
    }
}

TEST(JsonText, PutsAMemberInAsItsNeighborsAre) {
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

TEST(JsonText, PointersSpellKeysWithTheirSlashes) {
    for (const char* key : {"", "a/b", "~", "~1", "/~0/", "plain"})
        EXPECT_EQ(json_pointer_key(json_pointer("", key).substr(1)), key);
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
    size_t refused = 0;
    for (size_t length = 0; length < text.size(); ++length) {
        const std::string cut = text.substr(0, length);
        for (const char* pointer : {"/a/2/b/0/1", "/", "/new"}) {
            const ExitCode code = error_of([&] { with_json(cut, pointer, "1"); }).code;
            EXPECT_TRUE(code == ExitCode::ok || code == ExitCode::refused);
            refused += code == ExitCode::refused;
        }
    }
    EXPECT_GT(refused, 2 * text.size());
}

// Every number the reader may meet: digits as short as they can be, and the same bits behind double and float.
TEST(JsonText, NumbersKeepTheirBits) {
    _mm_setcsr(_mm_getcsr() & ~0x8040u); // the smallest floats too, whatever a test before has set
    EXPECT_EQ(json_number(0.1f), "0.1");
    EXPECT_EQ(json_number(400), "400");
    EXPECT_EQ(json_number(100000), "100000");
    EXPECT_EQ(json_number(-2.5f), "-2.5");
    // 7.038531e-26 is the shortest name of this float, but as a double it lies halfway to the next one.
    const float halfway = std::bit_cast<float>(0x15ae43fdu);
    EXPECT_EQ(static_cast<float>(parse_json(json_number(halfway), "number").number), halfway);
    for (uint32_t i = 0; i < 200000; ++i) {
        const float value = i < 2 ? std::bit_cast<float>(i << 31) : std::bit_cast<float>(hash(i, 17u)); // 0, -0, any
        if (!std::isfinite(value)) continue;
        const float read = static_cast<float>(parse_json(json_number(value), "number").number);
        ASSERT_EQ(std::bit_cast<uint32_t>(read), std::bit_cast<uint32_t>(value)) << json_number(value);
    }
}
}
