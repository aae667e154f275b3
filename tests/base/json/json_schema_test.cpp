#include "base/io/file.h"
#include "base/json/json.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace tyndall {
namespace {
using testing::HasSubstr;

// A small schema with every keyword that is explained.
constexpr const char* schema = R"({
  "type": "object", "additionalProperties": false, "required": ["version"],
  "properties": {
    "version": {"const": 1},
    "camera": {"type": "object", "additionalProperties": false, "required": ["fov"],
      "properties": {"fov": {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 180}, "vertical_shift": {"type": "number"},
                     "near": {"type": "number", "minimum": 0.001, "maximum": 10}}},
    "lights": {"type": "array", "items": {"$ref": "#/definitions/light"}, "minItems": 1, "maxItems": 3},
    "media": {"type": "array", "items": {"oneOf": [{"$ref": "#/definitions/even"}, {"$ref": "#/definitions/file"}]}},
    "size": {"type": "array", "items": {"type": "integer", "minimum": 1}, "minItems": 2, "maxItems": 2},
    "pair": {"type": "array", "items": [{"type": "string"}, {"type": "number"}], "additionalItems": false},
    "name": {"type": "string", "minLength": 1, "maxLength": 5, "pattern": "^[a-z]+$"},
    "tags": {"type": "array", "uniqueItems": true, "items": {"type": "string"}},
    "step": {"type": "integer", "multipleOf": 4},
    "mode": {"anyOf": [{"enum": ["fast", "slow"]}, {"const": 7}]},
    "curve": {"oneOf": [{"enum": ["even", "steep"]}, {"type": "array", "items": {"type": "number"}, "minItems": 2}]},
    "color": {"$ref": "#/$defs/color"},
    "back": {"type": "object", "properties": {"sky": {}, "image": {}, "tint": {}}, "additionalProperties": false,
      "oneOf": [{"required": ["sky"]}, {"required": ["image"]}]},
    "free": {"type": "object", "minProperties": 1, "maxProperties": 2, "patternProperties": {"^x_": {"type": "number"}}, "additionalProperties": {"type": "string"}},
    "shape": {"type": "object", "properties": {"kind": {"enum": ["box", "ball"]}, "radius": {"type": "number"}},
      "if": {"properties": {"kind": {"const": "ball"}}, "required": ["kind"]}, "then": {"required": ["radius"]}, "else": {"not": {"required": ["radius"]}}},
    "both": {"allOf": [{"type": "number"}, {"minimum": 5}]},
    "gone": false
  },
  "definitions": {
    "light": {"type": "object", "additionalProperties": false, "required": ["type", "power"],
      "properties": {"type": {"enum": ["point", "spot", "sun"]}, "power": {"$ref": "#/definitions/animated"}, "intensity": {}}},
    "animated": {"oneOf": [{"type": "number", "minimum": 0},
      {"type": "object", "additionalProperties": false, "required": ["keys"], "properties": {"keys": {"type": "array", "items": {"type": "number"}}, "loop": {"type": "boolean"}}}]},
    "even": {"type": "object", "additionalProperties": false, "required": ["type", "extinction"],
      "properties": {"type": {"const": "even"}, "extinction": {"$ref": "#/definitions/animated"}}},
    "file": {"type": "object", "additionalProperties": false, "required": ["type", "path"],
      "properties": {"type": {"const": "file"}, "path": {"type": "string"}, "grid": {"type": "string"}}}
  },
  "synonyms": {"extinction": ["density", "sigma_t"], "type": ["kind", "density"], "sun": ["directional"], "box": ["cuboid"]},
  "$defs": {"color": {"oneOf": [{"type": "number"}, {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}]}}
})";

TEST(JsonSchema, AcceptsWhatConforms) {
    for (
        const char* text : {
            R"({"version": 1})",
            R"({"version": 1.0, "camera": {"fov": 45, "near": 0.001}})",
            R"({"version": 1, "lights": [{"type": "sun", "power": 0}, {"type": "spot", "power": {"keys": [1, 2], "loop": true}}]})",
            R"({"version": 1, "media": [{"type": "even", "extinction": 1}, {"type": "file", "path": "a.vdb"}]})",
            R"({"version": 1, "size": [2.0, 3], "pair": ["a", 1], "name": "abc", "tags": ["a", "b"], "step": 8, "mode": 7})",
            R"({"version": 1, "color": [1, 2, 3], "back": {"sky": 1, "tint": 2}, "free": {"x_a": 1, "b": "c"}, "both": 5})",
            R"({"version": 1, "shape": {"kind": "ball", "radius": 1}})",
        }) {
        EXPECT_NO_THROW(check_schema(parse_json(text, "a.json"), schema, "a.json")) << text;
    }
}

TEST(JsonSchema, SaysWhereAndWhatWasExpected) {
    const struct {
        const char *member, *complaint;
    } cases[] = {
        {R"("camera": {"fovv": 45})", R"(/camera/fovv: unknown key; did you mean "fov"?)"},
        // Words of other programs, however they are written; only what is known at the place.
        {R"("media": [{"type": "even", "sigmaT": 1}])", R"(/media/0/sigmaT: unknown key; did you mean "extinction"?)"},
        {R"("media": [{"type": "even", "density": 1}])",
         R"(/media/0/density: unknown key; did you mean "type" or "extinction"?)"},
        {R"("lights": [{"density": 1}])", R"(/lights/0/density: unknown key; did you mean "type"?)"},
        {R"("lights": [{"type": "Directional"}])",
         R"(/lights/0/type: expected one of "point", "spot", "sun"; got "Directional"; did you mean "sun"?)"},
        {R"("shape": {"kind": "cuboid"})",
         R"(/shape/kind: expected one of "box", "ball"; got "cuboid"; did you mean "box"?)"},
        {R"("camera": {"FOV": 45})", R"(/camera/FOV: unknown key; did you mean "fov"?)"},
        {R"("camera": {"shift": 1})", R"(/camera/shift: unknown key; did you mean "vertical_shift"?)"},
        {R"("camera": {"vert": 1})", R"(/camera/vert: unknown key; did you mean "vertical_shift"?)"},
        {R"("camera": {"banana": 1})", R"(/camera/banana: unknown key; allowed here: "fov", "vertical_shift", "near")"},
        {R"("camera": {})", R"(/camera: missing key "fov")"},
        {R"("camera": {"fov": "wide"})", "/camera/fov: expected a number, got a string"},
        {R"("camera": {"fov": 0})", "/camera/fov: must be above 0 (is 0)"},
        {R"("camera": {"fov": 180})", "/camera/fov: must be below 180 (is 180)"},
        {R"("camera": {"fov": 1, "near": 1e-9})", "/camera/near: must be at least 0.001 (is 1e-09)"},
        {R"("camera": {"fov": 1, "near": 11})", "/camera/near: must be at most 10 (is 11)"},
        {R"("camera": null)", "/camera: expected an object, got null"},
        {R"("lights": [])", "/lights: must not be empty"},
        {R"("lights": [{"type": "pint", "power": 1}])",
         R"(/lights/0/type: expected one of "point", "spot", "sun"; got "pint")"},
        {R"("lights": [{"typ": "point", "power": 1}])", R"(/lights/0/typ: unknown key; did you mean "type"?)"},
        {R"("lights": [{"type": "sun"}])", R"(/lights/0: missing key "power")"},
        {R"("lights": [{"type": "sun", "power": -3}])", "/lights/0/power: must be at least 0 (is -3)"},
        {R"("lights": [{"type": "sun", "power": "x"}])",
         "/lights/0/power: expected a number or an object, got a string"},
        {R"("lights": [{"type": "sun", "power": {"keys": [1, "x"]}}])",
         "/lights/0/power/keys/1: expected a number, got a string"},
        {R"("lights": [{"type": "sun", "power": {"key": [1]}}])",
         R"(/lights/0/power/key: unknown key; did you mean "keys"?)"},
        {R"("lights": [1, 2, 3, 4])", "/lights: must have at most 3 items (has 4)"},
        {R"("media": [{"type": "even"}])", R"(/media/0: missing key "extinction")"},
        {R"("media": [{"type": "even", "path": "a"}])",
         R"(/media/0/path: unknown key; allowed here: "type", "extinction")"},
        {R"("media": [{"type": "evn", "extinction": 1}])",
         R"(/media/0/type: expected one of "even", "file"; got "evn")"},
        {R"("media": [{"tpye": "file", "path": "a"}])", R"(/media/0/tpye: unknown key; did you mean "type"?)"},
        {R"("media": [{"path": "a"}])", R"(/media/0: missing key "type"; expected one of "even", "file")"},
        {R"("media": [{"type": "file", "path": 3}])", "/media/0/path: expected a string, got 3"},
        {R"("media": ["a.vdb"])", "/media/0: expected an object, got a string"},
        {R"("size": [1.5, 2])", "/size/0: expected an integer, got 1.5"},
        {R"("size": [1e30, 1])", "/size/0: expected an integer, got 1e+30"},
        {R"("size": [1])", "/size: must have exactly 2 items (has 1)"},
        {R"("size": [0, 1])", "/size/0: must be at least 1 (is 0)"},
        {R"("pair": ["a", "b"])", "/pair/1: expected a number, got a string"},
        {R"("pair": ["a", 1, 2])", "/pair/2: is not allowed here"},
        {R"("name": "")", "/name: must not be empty"},
        {R"("name": "abcdef")", "/name: must have at most 5 characters (has 6)"},
        {R"("name": "ABC")", R"(/name: "ABC" does not match ^[a-z]+$)"},
        {R"("name": "\u00e4\u00e4\u00e4")", "does not match"},
        {R"("tags": ["a", "b", "a"])", "/tags: item 2 repeats item 0"},
        {R"("step": 6)", "/step: must be a multiple of 4 (is 6)"},
        {R"("mode": "fats")", R"(/mode: expected one of "fast", "slow", 7; got "fats")"},
        {R"("curve": [])", "/curve: must have at least 2 items (has 0)"},
        {R"("curve": [1, "x"])", "/curve/1: expected a number, got a string"},
        {R"("curve": "step")", R"(/curve: expected one of "even", "steep"; got "step")"},
        {R"("color": [1, 2])", "/color: must have exactly 3 items (has 2)"},
        {R"("color": "red")", "/color: expected a number or an array, got a string"},
        {R"("back": {"tint": 1})", R"(/back: needs one of "sky", "image")"},
        {R"("back": {"sky": 1, "image": 1})", R"(/back: takes only one of "sky", "image")"},
        {R"("free": {})", "/free: must not be empty"},
        {R"("free": {"a": "", "b": "", "c": ""})", "/free: must have at most 2 keys (has 3)"},
        {R"("free": {"x_a": "1"})", "/free/x_a: expected a number, got a string"},
        {R"("free": {"a": 1})", "/free/a: expected a string, got 1"},
        {R"("shape": {"kind": "ball"})", R"(/shape: missing key "radius")"},
        {R"("shape": {"kind": "box", "radius": 1})", "/shape: is not allowed here"},
        {R"("both": 4)", "/both: must be at least 5 (is 4)"},
        {R"("gone": 1)", "/gone: is not allowed here"},
    };
    for (const auto& [member, complaint] : cases) {
        SCOPED_TRACE(member);
        const Json document = parse_json(std::string(R"({"version": 1, )") + member + "}", "a.json");
        EXPECT_THAT(error_message(ExitCode::refused, [&] { check_schema(document, schema, "a.json"); }),
                    HasSubstr(std::string("a.json: ") +
                              (complaint[0] == '/' ? "" : "/name: \"\xc3\xa4\xc3\xa4\xc3\xa4\" ") + complaint));
    }
    for (const auto& [text, complaint] : {std::pair{"{}", R"(a.json: missing key "version")"},
                                          std::pair{"[]", "a.json: expected an object, got an array"},
                                          std::pair{R"({"version": 2})", "a.json: /version: expected 1; got 2"}})
        EXPECT_EQ(error_message(ExitCode::refused,
                                [&, json = text] { check_schema(parse_json(json, "a.json"), schema, "a.json"); }),
                  complaint);
}

TEST(JsonSchema, HugeStringsAndKeysAreRefusedBeforeAnyPatternSeesThem) {
    const auto refusal = [](const std::string& text) {
        return error_message(ExitCode::refused, [&] { check_schema(parse_json(text, "a.json"), schema, "a.json"); });
    };
    const std::string huge(5000000, 'a');
    EXPECT_THAT(refusal(R"({"version": 1, "name": ")" + huge + "\"}"),
                HasSubstr("a.json: /name: a string of 5000000 bytes"));
    EXPECT_THAT(refusal(R"({"version": 1, "free": {")" + huge + "\": 1}}"),
                HasSubstr("a.json: /free: a string of 5000000 bytes"));
    EXPECT_THAT(refusal(R"({"version": 1, "name": ")" + huge.substr(0, 10000) + "\"}"),
                HasSubstr("/name: must have at most 5"));
    EXPECT_THAT(refusal("{\"" + huge.substr(0, 9999) + "\": 1}"), HasSubstr("unknown key"));
}

TEST(JsonSchema, FileIsReadParsedAndChecked) {
    const TempFolder scratch;
    const auto read = [&](const std::filesystem::path& path) { return [path] { read_json(path, schema); }; };
    EXPECT_EQ(read_json(scratch.put("good.json", R"({"version": 1, "both": 6})"), schema).number_or("both", 0), 6);
    EXPECT_THAT(error_message(ExitCode::unreadable, read(scratch / "absent.json")),
                HasSubstr("absent.json: no such file"));
    EXPECT_THAT(error_message(ExitCode::refused, read(scratch.put("bad.json", "{"))),
                HasSubstr("bad.json: line 1, column 2: "));
    EXPECT_THAT(error_message(ExitCode::refused, read(scratch.put("old.json", R"({"version": 0})"))),
                HasSubstr("old.json: /version: expected 1"));
}

// Keywords of a schema and of those within it.
void collect_keywords(const Json& rules, std::set<std::string>& keywords) {
    for (const auto& [keyword, value] : rules.members) {
        keywords.insert(keyword);
        const bool named = keyword == "properties" || keyword == "patternProperties" || keyword == "definitions";
        if (named)
            for (const auto& member : value.members) collect_keywords(member.second, keywords);
        else if (keyword != "const" && keyword != "enum" && keyword != "default" && keyword != "examples" &&
                 keyword != "synonyms")
            collect_keywords(value, keywords);
        for (const Json& item : value.items) collect_keywords(item, keywords);
    }
}

// One that is not understood would be a rule that nothing breaks.
TEST(JsonSchema, ShippedSchemasUseKeywordsThatAreUnderstood) {
    const std::filesystem::path root = TYNDALL_SOURCE_DIR;
    const std::set<std::string> understood{
        "$ref", "additionalItems", "additionalProperties", "allOf", "anyOf", "const", "definitions", "else", "enum",
        "exclusiveMaximum", "exclusiveMinimum", "form", "if", "items", "maxItems", "maxLength", "maxProperties",
        "maximum", "minItems", "minLength", "minProperties", "minimum", "multipleOf", "not", "oneOf", "pattern",
        "patternProperties", "properties", "required", "synonyms", "then", "type", "uniqueItems",
        // Said to people and editors.
        "$comment", "$id", "$schema", "default", "description", "examples", "title"};
    for (const char* file : {"scenes/scene.schema.json", "volumes/recipe.schema.json"}) {
        std::set<std::string> keywords;
        collect_keywords(parse_json(read_file(root / file), file), keywords);
        EXPECT_TRUE(keywords.contains("$ref")) << file;
        for (const std::string& keyword : keywords)
            EXPECT_TRUE(understood.contains(keyword)) << file << ": " << keyword;
    }
}
}
}
