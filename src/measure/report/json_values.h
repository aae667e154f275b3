// JSON values for reports.
#pragma once
#include "base/io/json.h"

#include <cmath>
#include <string_view>

namespace tyndall::report {
inline Json text(std::string_view value) {
    Json result;
    result.kind = Json::Kind::string, result.string = value;
    return result;
}

// Null where it is not a finite number.
inline Json number(double value) {
    Json result;
    result.kind = std::isfinite(value) ? Json::Kind::number : Json::Kind::null, result.number = value;
    return result;
}

inline Json boolean(bool value) {
    Json result;
    result.kind = Json::Kind::boolean, result.boolean = value;
    return result;
}

inline Json array(std::vector<Json> items) {
    Json result;
    result.kind = Json::Kind::array, result.items = std::move(items);
    return result;
}

inline Json object(std::vector<std::pair<std::string, Json>> members) {
    Json result;
    result.kind = Json::Kind::object, result.members = std::move(members);
    return result;
}
}
