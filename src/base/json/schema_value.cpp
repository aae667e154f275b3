#pragma GCC diagnostic ignored "-Wmaybe-uninitialized" // GCC 12 warns of <regex> itself under sanitizers
#include "base/error.h"
#include "base/json/schema_problem.h"
#include "base/text.h"

#include <algorithm>
#include <cmath>
#include <regex>

namespace tyndall {
namespace {
bool is_whole(double number) { return number == std::floor(number); }

std::string with_article(const std::string& type) {
    if (type == "null") return type;
    return (std::string("aio").find(type[0]) != std::string::npos ? "an " : "a ") + type;
}

std::string type_name(const Json& value) {
    static const char* const names[] = {"null", "boolean", "number", "string", "array", "object"};
    return names[static_cast<size_t>(value.kind)];
}

std::string short_text(const Json& value) {
    const bool composed = value.kind == Json::Kind::array || value.kind == Json::Kind::object;
    return composed ? with_article(type_name(value)) : printable(format_json(value), 60);
}

std::string list_text(const std::vector<std::string>& texts) {
    constexpr size_t longest = 140, most = 360; // bytes per item, bytes in total: an error is one line
    std::string list;
    for (const std::string& text : texts) {
        if (!list.empty() && list.size() + text.size() > most) return list + ", ...";
        list += (list.empty() ? "" : ", ") + printable(text, longest);
    }
    return list;
}

struct Bound {
    const char *keyword, *text;
    bool (*holds)(double number, double bound);
};

constexpr Bound bounds[] = {
    {"minimum", "must be at least ", [](double number, double bound) { return number >= bound; }},
    {"exclusiveMinimum", "must be above ", [](double number, double bound) { return number > bound; }},
    {"maximum", "must be at most ", [](double number, double bound) { return number <= bound; }},
    {"exclusiveMaximum", "must be below ", [](double number, double bound) { return number < bound; }},
    {"multipleOf", "must be a multiple of ", [](double number, double bound) { return is_whole(number / bound); }},
};

std::string number_problem(double number, const Json& schema) {
    for (const auto& [keyword, text, holds] : bounds) {
        const Json* bound = schema.find(keyword);
        if (bound && !holds(number, bound->number))
            return text + format_json(bound->number) + " (is " + format_json(number) + ")";
    }
    return {};
}

// Checks a number of characters, items or keys against its allowed minimum and maximum.
std::string size_problem(size_t size, double least, double most, const std::string& what) {
    const double have = static_cast<double>(size);
    if (have >= least && have <= most) return {};
    if (size == 0 && least == 1) return "must not be empty";
    const double bound = have < least ? least : most;
    const char* relation = least == most ? "exactly " : have < least ? "at least " : "at most ";
    return "must have " + (relation + format_json(bound)) + " " + what + (bound == 1 ? "" : "s") + " (has " +
           format_json(have) + ")";
}

std::string string_problem(const std::string& text, const Json& schema) {
    const auto characters = std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; });
    const std::string problem = size_problem(static_cast<size_t>(characters), schema.number_or("minLength", 0),
                                             schema.number_or("maxLength", HUGE_VAL), "character");
    const Json* pattern = schema.find("pattern");
    if (!problem.empty() || !pattern || matches(text, pattern->string)) return problem;
    const std::string form = schema.string_or("form", "");
    return printable(quote_json(text), 60) + (form.empty() ? " does not match " + pattern->string : " is not " + form);
}

std::string array_problem(const std::vector<Json>& items, const Json& schema) {
    const std::string problem =
        size_problem(items.size(), schema.number_or("minItems", 0), schema.number_or("maxItems", HUGE_VAL), "item");
    if (!problem.empty() || !schema.boolean_or("uniqueItems", false)) return problem;
    for (size_t i = 0; i < items.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            if (equal(items[i], items[j])) return "item " + std::to_string(i) + " repeats item " + std::to_string(j);
    return {};
}
}

std::string value_problem(const Json& value, const Json& schema) {
    const std::vector<std::string> types = allowed_types(schema);
    const auto fits = [&](const std::string& type) { return has_type(value, type); };
    if (!types.empty() && std::none_of(types.begin(), types.end(), fits)) return expected_types(types, value);

    const std::vector<const Json*> allowed = allowed_values(schema);
    const auto same = [&](const Json* other) { return equal(value, *other); };
    if (!allowed.empty() && std::none_of(allowed.begin(), allowed.end(), same)) return expected_values(allowed, &value);

    if (value.kind == Json::Kind::number) return number_problem(value.number, schema);
    if (value.kind == Json::Kind::string) return string_problem(value.string, schema);
    if (value.kind == Json::Kind::array) return array_problem(value.items, schema);
    if (value.kind == Json::Kind::object)
        return size_problem(value.members.size(), schema.number_or("minProperties", 0),
                            schema.number_or("maxProperties", HUGE_VAL), "key");
    return {};
}

bool matches(const std::string& text, const std::string& pattern) {
    return std::regex_search(text, std::regex(pattern));
}

std::vector<const Json*> allowed_values(const Json& schema) {
    if (const Json* only = schema.find("const")) return {only};
    std::vector<const Json*> values;
    if (const Json* several = schema.find("enum"))
        for (const Json& item : several->items) values.push_back(&item);
    return values;
}

std::string expected_values(const std::vector<const Json*>& allowed, const Json* value) {
    std::vector<std::string> texts;
    for (const Json* item : allowed)
        if (const std::string text = short_text(*item); std::find(texts.begin(), texts.end(), text) == texts.end())
            texts.push_back(text);
    const std::string expected = (texts.size() == 1 ? "expected " : "expected one of ") + list_text(texts);
    return value ? expected + "; got " + short_text(*value) : expected;
}

std::vector<std::string> allowed_types(const Json& schema) {
    const Json* type = schema.find("type");
    if (!type) return {};
    if (type->kind == Json::Kind::string) return {type->string};
    std::vector<std::string> types;
    for (const Json& item : type->items) types.push_back(item.string);
    return types;
}

bool has_type(const Json& value, const std::string& type) {
    constexpr double exact = 0x1p53; // doubles beyond this skip integers
    if (type == "integer")
        return value.kind == Json::Kind::number && is_whole(value.number) && std::fabs(value.number) <= exact;
    return type == type_name(value);
}

std::string expected_types(const std::vector<std::string>& types, const Json& value) {
    std::vector<std::string> names;
    for (const std::string& type : types)
        if (std::find(names.begin(), names.end(), with_article(type)) == names.end())
            names.push_back(with_article(type));
    const bool fraction = value.kind == Json::Kind::number; // where only an integer would do
    return "expected " + joined(names, " or ") + ", got " +
           (fraction ? format_json(value.number) : with_article(type_name(value)));
}

std::string quoted_list(const std::vector<std::string>& names) {
    std::vector<std::string> texts;
    for (const std::string& name : names) texts.push_back(quote_json(name));
    return list_text(texts);
}

bool equal(const Json& a, const Json& b) {
    if (a.kind != b.kind || a.boolean != b.boolean || a.number != b.number || a.string != b.string) return false;
    if (a.members.size() != b.members.size()) return false;
    const auto same_member = [&](const auto& member) {
        const Json* other = b.find(member.first);
        return other && equal(member.second, *other);
    };
    return std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), equal) &&
           std::all_of(a.members.begin(), a.members.end(), same_member);
}
}
