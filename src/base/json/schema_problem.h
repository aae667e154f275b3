// Describes in one sentence where and why a document violates a JSON schema.
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

// The first problem in document order, from the union branch that the author most likely meant; none if the document
// conforms. Supports draft 7 except contains, dependencies, propertyNames and format.
std::optional<SchemaProblem> schema_problem(const Json& document, const Json& schema);

// What is wrong with a value's own type, range or size, ignoring its members and items; empty if nothing is.
std::string value_problem(const Json& value, const Json& schema);

// The values that a `const` or `enum` allows; empty if the schema has neither.
std::vector<const Json*> allowed_values(const Json& schema);

// 'expected one of "point", "spot", "sun"; got "spto"', without the last part if `value` is null.
std::string expected_values(const std::vector<const Json*>& allowed, const Json* value = nullptr);

// The types that a schema's `type` allows; empty if it has none.
std::vector<std::string> allowed_types(const Json& schema);
bool has_type(const Json& value, const std::string& type);

// "expected a number or an array, got a string"
std::string expected_types(const std::vector<std::string>& types, const Json& value);

// '"near", "far"', shortened with dots if too long.
std::string quoted_list(const std::vector<std::string>& names);

// True if a regular expression (ECMAScript) matches anywhere in the text.
bool matches(const std::string& text, const std::string& pattern);

// Deep equality; the order of an object's members does not matter.
bool equal(const Json& a, const Json& b);
}
