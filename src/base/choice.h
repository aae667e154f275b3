// A word out of a few, as options, settings and scripts take it.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// The position of `text` among `choices`. Throws Error (usage) at `where`: names those like it, or lists all.
size_t choice_among(std::string_view where, std::string_view text, const std::vector<std::string>& choices);
}
