// Small helpers for messages that name things.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

std::string joined(const std::vector<std::string>& words, std::string_view separator);

// The candidate with the fewest edits (insert, delete, replace, swap of neighbours) from `name`; the first on a tie.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);
}
