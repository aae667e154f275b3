// The recursive schema check, shared by the rules for members and items and the rules for unions.
#pragma once
#include "base/json/schema_problem.h"

namespace tyndall {
using Problem = std::optional<SchemaProblem>;

// The first problem of a value checked against `schema`, a subschema of `root`.
Problem find_problem(const Json& value, const Json& schema, const Json& root, const std::string& pointer);

// The first problem from anyOf and oneOf alone.
Problem union_problem(const Json& value, const Json& schema, const Json& root, const std::string& pointer);

// The schema at the end of a chain of local references (#, #/definitions/x).
const Json& resolved(const Json& schema, const Json& root);

// Keys of an object, strings of an array; empty if the pointer is null.
std::vector<std::string> keys_of(const Json* object);
std::vector<std::string> strings_of(const Json* array);

// 'unknown key; did you mean "fov"?', matched by the terms of other programs that the schema `root` lists as "synonyms"
// and by spelling; lists the known keys if nothing is close.
std::string unknown_key(const std::string& key, const std::vector<std::string>& known, const Json& root);

// '; did you mean "sun"?' for a disallowed value that is a synonym of an allowed one; else empty.
std::string meant_value(const Json& value, const std::vector<const Json*>& allowed, const Json& root);
}
