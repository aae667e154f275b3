// Builds the Json tree from nlohmann's SAX parser, so limits are enforced before anything is stored.
#include "base/error.h"
#include "base/json/json.h"
#include "base/json/json_pointer.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <unordered_set>

namespace tyndall {
namespace {
constexpr size_t max_levels = 64;

std::string position_text(std::string_view text, size_t position) {
    std::string_view before = text.substr(0, position ? std::min(position - 1, text.size()) : 0);
    if (before.starts_with("\xef\xbb\xbf")) before.remove_prefix(3);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const size_t line_start = before.rfind('\n') + 1; // npos + 1 is 0
    const auto column = std::count_if(before.begin() + static_cast<std::ptrdiff_t>(line_start), before.end(),
                                      [](char c) { return (c & 0xc0) != 0x80; }) +
                        1;
    return "line " + std::to_string(line) + ", column " + std::to_string(column) + ": ";
}

// The library's message without its own prefix and position.
std::string_view plain_message(std::string_view message) {
    const size_t tag = message.find("] ");
    if (message.starts_with("[json.exception") && tag != message.npos) message.remove_prefix(tag + 2);
    const size_t position = message.find(": ");
    if (message.starts_with("parse error at") && position != message.npos) message.remove_prefix(position + 2);
    return message;
}

class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
public:
    TreeBuilder(std::string_view text, std::string_view file, size_t max_values)
        : text_(text), file_(file), max_values_(max_values) {}
    Json root;

    bool null() override { return add(Json::Kind::null), true; }
    bool boolean(bool value) override { return add(Json::Kind::boolean).boolean = value, true; }
    bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
    bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
    bool number_float(number_float_t value, const string_t&) override { return number(value); }
    bool string(string_t& value) override {
        if (value.find('\0') != value.npos)
            refuse(json_location(file_, next_pointer()), "the string contains a zero byte");
        return add(Json::Kind::string).string = std::move(value), true;
    }
    bool binary(binary_t&) override { return false; } // not part of JSON text

    bool start_object(size_t) override { return open(Json::Kind::object); }
    bool start_array(size_t) override { return open(Json::Kind::array); }
    bool end_object() override { return levels_.pop_back(), true; }
    bool end_array() override { return levels_.pop_back(), true; }
    bool key(string_t& name) override {
        Level& level = levels_.back();
        if (name.find('\0') != name.npos) refuse(json_location(file_, pointer()), "a key contains a zero byte");
        if (!level.keys.insert(name).second)
            refuse(json_location(file_, json_pointer(pointer(), name)), "the key appears twice");
        level.value->members.emplace_back(std::move(name), Json{});
        return true;
    }

    bool parse_error(size_t position, const std::string&, const nlohmann::json::exception& error) override {
        refuse(file_, position_text(text_, position) + std::string(plain_message(error.what())));
    }

private:
    struct Level {
        Json* value;
        std::unordered_set<std::string> keys;
    };

    bool number(double value) { return add(Json::Kind::number).number = value, true; }

    bool open(Json::Kind kind) {
        if (levels_.size() >= max_levels)
            refuse(json_location(file_, next_pointer()),
                   "nested deeper than " + std::to_string(max_levels) + " levels");
        levels_.push_back({&add(kind), {}});
        return true;
    }

    // The returned reference stays valid while the value is open: its parent grows only after it is complete.
    Json& add(Json::Kind kind) {
        if (++count_ > max_values_) refuse(file_, "more than " + std::to_string(max_values_) + " JSON values");
        Json* place = &root;
        if (!levels_.empty()) {
            Json& parent = *levels_.back().value;
            place = parent.kind == Json::Kind::array ? &parent.items.emplace_back() : &parent.members.back().second;
        }
        place->kind = kind;
        return *place;
    }

    // Pointer to the innermost open value.
    std::string pointer() const {
        std::string result;
        for (size_t i = 0; i + 1 < levels_.size(); ++i) {
            const Json& parent = *levels_[i].value;
            result = parent.kind == Json::Kind::array ? json_pointer(result, parent.items.size() - 1)
                                                      : json_pointer(result, parent.members.back().first);
        }
        return result;
    }

    // Pointer to the value about to be added.
    std::string next_pointer() const {
        if (levels_.empty()) return "";
        const Json& parent = *levels_.back().value;
        return parent.kind == Json::Kind::array ? json_pointer(pointer(), parent.items.size())
                                                : json_pointer(pointer(), parent.members.back().first);
    }

    std::string_view text_, file_;
    std::vector<Level> levels_;
    size_t max_values_, count_ = 0;
};
}

Json parse_json(std::string_view text, std::string_view file, size_t max_values) {
    TreeBuilder builder(text, file, max_values);
    constexpr bool nothing_behind = true, comments = true;
    nlohmann::json::sax_parse(text.begin(), text.end(), &builder, nlohmann::json::input_format_t::json, nothing_behind,
                              comments);
    return std::move(builder.root);
}
}
