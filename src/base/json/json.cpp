#include "base/json/json.h"

#include "base/io/file.h"
#include "base/utf8.h"

#include <cassert>
#include <charconv>
#include <cmath>

namespace tyndall {
Json::Json(const Box& box) {
    if (!box.empty()) kind = Kind::object, members = {{"low", box.low}, {"high", box.high}};
}

const Json* Json::find(std::string_view key) const {
    for (const auto& [name, value] : members)
        if (name == key) return &value;
    return nullptr;
}

double Json::number_or(std::string_view key, double otherwise) const {
    const Json* value = find(key);
    assert(!value || value->kind == Kind::number);
    return value ? value->number : otherwise;
}

bool Json::boolean_or(std::string_view key, bool otherwise) const {
    const Json* value = find(key);
    assert(!value || value->kind == Kind::boolean);
    return value ? value->boolean : otherwise;
}

std::string Json::string_or(std::string_view key, std::string_view otherwise) const {
    const Json* value = find(key);
    assert(!value || value->kind == Kind::string);
    return value ? value->string : std::string(otherwise);
}

Json read_json(const std::filesystem::path& path, std::string_view schema_text) {
    const std::string file = path.string();
    Json document = parse_json(read_file(path), file);
    check_schema(document, schema_text, file);
    return document;
}

namespace {
void append_number(std::string& text, double number) {
    char digits[32];
    assert(std::isfinite(number));
    // Whole numbers have no exponent: readers that expect an integer reject 1e+05.
    const bool whole = number == std::floor(number) && std::abs(number) < 1e15;
    char* const end = digits + sizeof digits;
    text.append(digits, whole ? std::to_chars(digits, end, number, std::chars_format::fixed).ptr
                              : std::to_chars(digits, end, number).ptr);
}

void append(std::string& text, const Json& value) {
    switch (value.kind) {
    case Json::Kind::null:
        text += "null";
        return;
    case Json::Kind::boolean:
        text += value.boolean ? "true" : "false";
        return;
    case Json::Kind::number:
        append_number(text, value.number);
        return;
    case Json::Kind::string:
        text += quote_json(value.string);
        return;
    case Json::Kind::array:
        for (const Json& item : value.items) {
            text += &item == value.items.data() ? '[' : ',';
            append(text, item);
        }
        text += value.items.empty() ? "[]" : "]";
        return;
    case Json::Kind::object:
        for (const auto& member : value.members) {
            text += &member == value.members.data() ? '{' : ',';
            text += quote_json(member.first) + ":";
            append(text, member.second);
        }
        text += value.members.empty() ? "{}" : "}";
        return;
    }
}
}

std::string format_json(const Json& value) {
    std::string text;
    append(text, value);
    return text;
}

std::string quote_json(std::string_view text) {
    std::string result = "\"";
    while (!text.empty()) {
        const size_t length = utf8_length(text);
        const unsigned char c = static_cast<unsigned char>(text.front());
        if (length == 0) {
            result += "\\ufffd";
        } else if (c == '"' || c == '\\') {
            result += {'\\', static_cast<char>(c)};
        } else if (c == '\n') {
            result += "\\n";
        } else if (c < 0x20 || c == 0x7f) {
            result += {'\\', 'u', '0', '0', "0123456789abcdef"[c >> 4], "0123456789abcdef"[c & 15]};
        } else {
            result += text.substr(0, length);
        }
        text.remove_prefix(std::max<size_t>(length, 1));
    }
    return result + "\"";
}
}
