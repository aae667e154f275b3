// Helpers for formatting messages.
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

// ASCII letters in lower case.
std::string lower_case(std::string text);

// Sixteen digits, those above 9 in lower case.
std::string hex_digits(uint64_t value);

std::string joined(const std::vector<std::string>& words, std::string_view separator);

// The fewest digits that round-trip.
template<class T> std::string shortest_text(T value) {
    char text[64];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// The number that the whole text spells; nothing if any character is left over.
template<class T> std::optional<T> parsed(std::string_view text) {
    T value{};
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    return problem == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

// Human-readable: "2.1 min", "1.5 MB", "2 meshes".
std::string seconds_text(double seconds);
std::string bytes_text(double bytes);
std::string count_text(uint64_t count, std::string_view noun);

// "light Key"; just "light 1" if the name already begins with the kind.
std::string named(std::string_view kind, std::string_view name);

// Wraps text at spaces into lines of at most `width` bytes; all but the first are indented by `indent` spaces.
std::string wrapped(std::string_view text, size_t width, size_t indent);

// A word quoted for a POSIX shell: unchanged, or in single quotes.
std::string quoted_for_shell(std::string_view word);

// "no camera 'mian'; did you mean main?", or the known names if nothing is close and the list is short.
std::string unknown_name(std::string_view kind, std::string_view name, const std::vector<std::string>& known);

// The candidate with the fewest edits (insert, delete, replace, swap adjacent) from `name`; the first on a tie.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

// The index of `text` among `choices`. Throws Error (usage) at `where`, suggesting similar choices or listing all.
size_t choice_among(std::string_view where, std::string_view text, const std::vector<std::string>& choices);
}
