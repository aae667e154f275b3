// Helpers that build JSON reports.
#pragma once
#include "base/json/json.h"

namespace tyndall {
using JsonMembers = std::vector<std::pair<std::string, Json>>;

inline Json json_object(JsonMembers members) {
    Json result;
    result.kind = Json::Kind::object, result.members = std::move(members);
    return result;
}

// An array of make(value) for each value.
template<class Range, class Make> Json json_list(const Range& values, const Make& make) {
    std::vector<Json> items;
    for (const auto& value : values) items.push_back(make(value));
    return items;
}

// An object as a one-line report.
inline std::string json_line(JsonMembers members) { return format_json(json_object(std::move(members))) + "\n"; }
}
