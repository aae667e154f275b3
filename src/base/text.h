// Small helpers for messages that name things.
#pragma once
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

std::string joined(const std::vector<std::string>& words, std::string_view separator);

// The fewest digits that read back the same.
template<class T> std::string shortest_text(T value) {
    char text[64];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// A text that is a number from its first to its last letter.
template<class T> std::optional<T> parsed(std::string_view text) {
    T value{};
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    return problem == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

// "2.1 min", "1.5 MB", "2 leaves": for people.
std::string seconds_text(double seconds);
std::string bytes_text(double bytes);
std::string count_text(uint64_t count, std::string_view noun);

// "light Key", but "light 1" of what has only its kind and number for a name.
std::string named(std::string_view kind, std::string_view name);

// Lines of at most `width` bytes, broken at spaces; all but the first begin with `indent` spaces.
std::string wrapped(std::string_view text, size_t width, size_t indent);

// A word as a POSIX shell reads it back: as it is, or in single quotes.
std::string quoted_for_shell(std::string_view word);

// "no camera 'mian'; did you mean main?", or what there is when nothing is near and the list is short.
std::string unknown_name(std::string_view kind, std::string_view name, const std::vector<std::string>& known);

// The candidate with the fewest edits (insert, delete, replace, swap of neighbours) from `name`; the first on a tie.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

// The position of `text` among `choices`. Throws Error (usage) at `where`: names those like it, or lists all.
size_t choice_among(std::string_view where, std::string_view text, const std::vector<std::string>& choices);
}
