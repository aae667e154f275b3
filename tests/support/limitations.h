// What a mode says of itself, for tests.
#pragma once
#include "modes/limitation.h"

#include <algorithm>

namespace tyndall {
inline bool has_limitation(const Limitations& limitations, const LimitationKind& kind) {
    return std::ranges::any_of(limitations, [&](const Limitation& one) { return one.is(kind); });
}

inline bool has_limitation(const Limitations& limitations, Subject subject, std::string_view name) {
    return std::ranges::any_of(limitations,
                               [&](const Limitation& one) { return one.subject == subject && one.name == name; });
}
}
