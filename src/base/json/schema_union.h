// The walk over a schema, shared by the rules for members and items and the rules for alternatives.
#pragma once
#include "base/json/schema_problem.h"

namespace tyndall {
using Problem = std::optional<SchemaProblem>;

// The first problem of a value under a part of the schema `root`.
Problem find_problem(const Json& value, const Json& schema, const Json& root, const std::string& pointer);

// The part of it that comes from anyOf and oneOf.
Problem union_problem(const Json& value, const Json& schema, const Json& root, const std::string& pointer);

// The schema that a chain of local references (#, #/definitions/x) ends at.
const Json& resolved(const Json& schema, const Json& root);

// Keys of an object, strings of an array; empty when it is null.
std::vector<std::string> keys_of(const Json* object);
std::vector<std::string> strings_of(const Json* array);

// 'unknown key; did you mean "fov"?', by the words of other programs that the schema `root` lists as "synonyms" and by
// the spelling, or what is known when nothing is near.
std::string unknown_key(const std::string& key, const std::vector<std::string>& known, const Json& root);

// '; did you mean "sun"?' of a value that is none of those allowed, by the same synonyms; else empty.
std::string meant_value(const Json& value, const std::vector<const Json*>& allowed, const Json& root);
}
