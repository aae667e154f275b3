// Numbered file names: one frame token in the syntax of Blender, printf, Houdini, RV or husk.
#include "base/io/frames.h"

#include "base/error.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

namespace tyndall {
namespace {
constexpr size_t max_digits = 12;

struct Token {
    size_t start = 0, length = 0;
    size_t digits = 1; // minimum number of digits
};

[[noreturn]] void complain(std::string_view pattern, size_t column, const std::string& what) {
    fail(ExitCode::usage, printable(pattern, 120), "column " + std::to_string(column + 1) + ": " + what);
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return is_digit(c) || c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// Parses a decimal width and moves `at` past it. Values stop growing once out of range; the caller rejects them.
size_t width(std::string_view pattern, size_t& at) {
    size_t value = 0;
    for (; at < pattern.size() && is_digit(pattern[at]); ++at)
        if (value < 999) value = 10 * value + static_cast<size_t>(pattern[at] - '0');
    return value;
}

// #### stands for as many digits as there are marks; a single # for four.
Token hash_token(std::string_view pattern, size_t start) {
    size_t end = pattern.find_first_not_of('#', start);
    if (end == std::string_view::npos) end = pattern.size();
    return {start, end - start, end - start == 1 ? 4 : end - start};
}

// @@@@ stands for as many digits as there are marks; a single @ is part of the name.
std::optional<Token> at_token(std::string_view pattern, size_t start) {
    const size_t end = std::min(pattern.find_first_not_of('@', start), pattern.size());
    if (end - start == 1) return {};
    return Token{start, end - start, end - start};
}

// <F> or <F4>; anything else in angle brackets is left as is.
std::optional<Token> angle_token(std::string_view pattern, size_t start) {
    if (pattern.substr(start, 2) != "<F") return {};
    size_t at = start + 2;
    const size_t first = at, digits = width(pattern, at);
    if (at >= pattern.size() || pattern[at] != '>') return {};
    if (at > first && digits == 0) complain(pattern, start, "<F> takes a width from 1 to 12");
    return Token{start, at + 1 - start, at == first ? 1 : digits};
}

// %d or %04d; no other printf conversion.
Token percent_token(std::string_view pattern, size_t start) {
    size_t at = start + 1;
    const bool padded = at < pattern.size() && pattern[at] == '0';
    const size_t digits = padded ? width(pattern, at) : 1;
    if (at >= pattern.size() || pattern[at] != 'd' || digits == 0)
        complain(pattern, start, "only %d and %04d are supported for the frame number");
    return {start, at + 1 - start, digits};
}

// $F or $F4; any other variable is left as is.
std::optional<Token> dollar_token(std::string_view pattern, size_t start) {
    if (pattern.substr(start, 2) != "$F") return {};
    size_t at = start + 2;
    const size_t first = at, digits = width(pattern, at);
    if (at == first && at < pattern.size() && is_word(pattern[at])) return {};
    if (at > first && digits == 0) complain(pattern, start, "$F takes a width from 1 to 12");
    return Token{start, at - start, at == first ? 1 : digits};
}

std::optional<Token> find_token(std::string_view pattern) {
    std::optional<Token> found;
    for (size_t at = 0; at < pattern.size();) {
        std::optional<Token> token;
        if (pattern[at] == '#') token = hash_token(pattern, at);
        if (pattern[at] == '%') token = percent_token(pattern, at);
        if (pattern[at] == '$') token = dollar_token(pattern, at);
        if (pattern[at] == '@') token = at_token(pattern, at);
        if (pattern[at] == '<') token = angle_token(pattern, at);
        at += token ? token->length : 1;
        if (!token) continue;
        if (token->digits > max_digits) complain(pattern, token->start, "a frame number takes at most 12 digits");
        if (found) complain(pattern, token->start, "the name already has a frame number");
        found = token;
    }
    return found;
}
}

bool has_frame_token(std::string_view pattern) { return find_token(pattern).has_value(); }

std::string frame_name(std::string_view pattern, int frame) {
    const std::optional<Token> token = find_token(pattern);
    if (!token) return std::string(pattern);
    std::string number = std::to_string(std::abs(static_cast<long long>(frame)));
    if (number.size() < token->digits) number.insert(0, token->digits - number.size(), '0');
    if (frame < 0) number.insert(0, 1, '-');
    return std::string(pattern.substr(0, token->start)) + number +
           std::string(pattern.substr(token->start + token->length));
}

std::string with_word(std::string_view pattern, std::string_view word) {
    const std::optional<Token> token = find_token(pattern);
    const size_t name = pattern.find_last_of('/') + 1, dot = pattern.find_last_of('.');
    const bool extension = dot != std::string_view::npos && dot > name;
    size_t place = pattern.size();
    if (token)
        place = token->start;
    else if (extension)
        place = dot + 1;
    std::string result(pattern.substr(0, place));
    if (!token && !extension) result += '.';
    result += word;
    if (token || extension) result += '.';
    return result + std::string(pattern.substr(place));
}
}
