// Says in one sentence where and why a document breaks a JSON schema.
#pragma once
#include "base/json/json.h"

#include <optional>
#include <string>
#include <vector>

namespace tyndall {
struct SchemaProblem {
    std::string pointer; // of the offending value or key
    std::string what;
};

// The first problem in document order, from the branch of a union that the author most likely meant; none when the
// document conforms. Draft 7 but for contains, dependencies, propertyNames and format.
std::optional<SchemaProblem> schema_problem(const Json& document, const Json& schema);

// What is wrong with a value itself, its type, range or size, leaving out what it contains; empty when nothing is.
std::string value_problem(const Json& value, const Json& schema);

// The values that a `const` or `enum` allows; empty when the schema has neither.
std::vector<const Json*> allowed_values(const Json& schema);

// 'expected one of "point", "spot", "sun"; got "spto"', or without the end when there is no value.
std::string expected_values(const std::vector<const Json*>& allowed, const Json* value = nullptr);

// The types that a schema's `type` allows; empty when it has none.
std::vector<std::string> allowed_types(const Json& schema);
bool has_type(const Json& value, const std::string& type);

// "expected a number or an array, got a string"
std::string expected_types(const std::vector<std::string>& types, const Json& value);

// '"near", "far"', cut with dots when it gets long.
std::string quoted_list(const std::vector<std::string>& names);

// Whether a regular expression (ECMAScript) fits some part of a text.
bool matches(const std::string& text, const std::string& pattern);

// Whether two documents mean the same; the members of an object may be in any order.
bool equal(const Json& a, const Json& b);
}
