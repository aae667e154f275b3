#include "base/text.h"

#include "base/error.h"

#include <algorithm>
#include <cctype>
#include <cstdarg>
#include <cstdio>
#include <limits>

namespace tyndall {
namespace {
// Optimal string alignment distance.
size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<size_t>> cost(a.size() + 1, std::vector<size_t>(b.size() + 1));
    for (size_t i = 0; i <= a.size(); ++i) {
        for (size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                cost[i][j] = i + j;
                continue;
            }
            const bool same = a[i - 1] == b[j - 1];
            cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, cost[i - 1][j - 1] + !same});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
        }
    }
    return cost[a.size()][b.size()];
}
}

std::string formatted(const char* format, ...) {
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    const int length = std::vsnprintf(nullptr, 0, format, arguments);
    va_end(arguments);
    std::string result(static_cast<size_t>(std::max(length, 0)) + 1, '\0');
    std::vsnprintf(result.data(), result.size(), format, again);
    va_end(again);
    result.pop_back();
    return result;
}

std::string lower_case(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string hex_digits(uint64_t value) {
    std::string digits(16, '0');
    for (size_t i = 16; i-- > 0; value >>= 4) digits[i] = "0123456789abcdef"[value & 15];
    return digits;
}

std::string joined(const std::vector<std::string>& words, std::string_view separator) {
    std::string result;
    for (const std::string& word : words) result += (result.empty() ? "" : std::string(separator)) + word;
    return result;
}

std::string seconds_text(double seconds) {
    if (seconds < 0.0995) return formatted("%.0f ms", seconds * 1000);
    if (seconds < 120) return formatted("%.1f s", seconds);
    if (seconds < 7200) return formatted("%.1f min", seconds / 60);
    return formatted("%.1f h", seconds / 3600);
}

std::string bytes_text(double bytes) {
    constexpr const char* units[] = {"B", "kB", "MB", "GB", "TB"};
    size_t unit = 0;
    while (bytes >= 1000 && unit < 4) bytes /= 1000, ++unit;
    return formatted(unit == 0 || bytes >= 100 ? "%.0f %s" : "%.1f %s", bytes, units[unit]);
}

std::string count_text(uint64_t count, std::string_view noun) {
    return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : noun.ends_with("sh") ? "es" : "s");
}

std::string named(std::string_view kind, std::string_view name) {
    const bool said = name.starts_with(std::string(kind) + " ");
    return said ? std::string(name) : std::string(kind) + " " + std::string(name);
}

std::string wrapped(std::string_view text, size_t width, size_t indent) {
    std::string result;
    while (text.size() > width) {
        const size_t space = text.rfind(' ', width);
        if (space == text.npos || space == 0) break;
        result += std::string(text.substr(0, space)) + "\n" + std::string(indent, ' ');
        text.remove_prefix(space + 1);
    }
    return result + std::string(text);
}

std::string quoted_for_shell(std::string_view word) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+@%";
    if (!word.empty() && word.find_first_not_of(plain) == word.npos) return std::string(word);
    std::string text = "'";
    for (const char letter : word) text += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return text + "'";
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
    const std::string_view start = name.substr(0, 64);
    const auto nearer = [&](const std::string& a, const std::string& b) {
        return edit_distance(start, a) < edit_distance(start, b);
    };
    const auto best = std::min_element(candidates.begin(), candidates.end(), nearer);
    return best == candidates.end() ? std::string() : *best;
}

std::string unknown_name(std::string_view kind, std::string_view name, const std::vector<std::string>& known) {
    constexpr size_t longest_list = 32, max_near = 3;
    const std::string_view start = name.substr(0, 64);
    std::vector<std::string> near;
    size_t fewest = std::numeric_limits<size_t>::max();
    for (const std::string& candidate : known) {
        const size_t edits = edit_distance(start, candidate);
        if (2 * edits > std::max(start.size(), candidate.size()) || edits > fewest) continue;
        if (edits < fewest) near.clear();
        fewest = edits, near.push_back(candidate);
    }
    if (near.size() > max_near) near.resize(max_near);
    std::string text = "no " + std::string(kind) + " '" + printable(name, 60) + "'";
    if (!near.empty()) return text + "; did you mean " + joined(near, " or ") + "?";
    if (known.empty()) return text + "; none exist";
    return known.size() > longest_list ? text : text + "; available: " + joined(known, ", ");
}

size_t choice_among(std::string_view where, std::string_view text, const std::vector<std::string>& choices) {
    const auto found = std::ranges::find(choices, text);
    if (found == choices.end()) fail(ExitCode::usage, where, unknown_name("choice", text, choices));
    return static_cast<size_t>(found - choices.begin());
}
}
