// Reports put together from values that Json takes: numbers, texts, vectors, lists.
#pragma once
#include "base/json/json.h"

namespace tyndall {
using JsonMembers = std::vector<std::pair<std::string, Json>>;

inline Json json_object(JsonMembers members) {
    Json result;
    result.kind = Json::Kind::object, result.members = std::move(members);
    return result;
}

// An array of what `make` makes of each value.
template<class Range, class Make> Json json_list(const Range& values, const Make& make) {
    std::vector<Json> items;
    for (const auto& value : values) items.push_back(make(value));
    return items;
}

// An object as a report of one line.
inline std::string json_line(JsonMembers members) { return format_json(json_object(std::move(members))) + "\n"; }
}
