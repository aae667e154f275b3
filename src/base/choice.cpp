#include "base/choice.h"

#include "base/error.h"
#include "base/text.h"

#include <algorithm>

namespace tyndall {
size_t choice_among(std::string_view where, std::string_view text, const std::vector<std::string>& choices) {
    const auto found = std::ranges::find(choices, text);
    if (found == choices.end()) fail(ExitCode::usage, where, unknown_name("choice", text, choices));
    return static_cast<size_t>(found - choices.begin());
}
}
