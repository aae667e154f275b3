#include "base/json/schema_problem.h"

#include "base/json/json_pointer.h"
#include "base/json/schema_union.h"
#include "base/text.h"

#include <algorithm>
#include <cassert>
#include <cctype>

namespace tyndall {
const Json& resolved(const Json& schema, const Json& root) {
    const Json* reference = schema.find("$ref");
    if (!reference) return schema;
    const Json* place = &root;
    std::string_view rest = reference->string;
    assert(rest.starts_with('#'));
    rest.remove_prefix(1);
    while (!rest.empty() && place) {
        rest.remove_prefix(1);
        const std::string_view key = rest.substr(0, rest.find('/'));
        rest.remove_prefix(key.size());
        place = place->find(key);
    }
    assert(place && place != &schema && "a reference in a schema leads nowhere");
    return resolved(*place, root);
}

std::vector<std::string> keys_of(const Json* object) {
    std::vector<std::string> keys;
    if (object)
        for (const auto& member : object->members) keys.push_back(member.first);
    return keys;
}

std::vector<std::string> strings_of(const Json* array) {
    std::vector<std::string> strings;
    if (array)
        for (const Json& item : array->items) strings.push_back(item.string);
    return strings;
}

namespace {
// The schemas that apply to a member of an object: by name, by name pattern, or else additionalProperties.
std::vector<const Json*> member_schemas(const std::string& key, const Json& schema) {
    std::vector<const Json*> schemas;
    const Json *properties = schema.find("properties"), *patterns = schema.find("patternProperties");
    const Json* named = properties ? properties->find(key) : nullptr;
    if (named) schemas.push_back(named);
    if (patterns)
        for (const auto& [pattern, one] : patterns->members)
            if (matches(key, pattern)) schemas.push_back(&one);
    const Json* additional = schema.find("additionalProperties");
    if (schemas.empty() && additional) schemas.push_back(additional);
    return schemas;
}

bool is_false(const Json& schema) { return schema.kind == Json::Kind::boolean && !schema.boolean; }

Problem members_problem(const Json& value, const Json& schema, const Json& root, const std::string& pointer) {
    for (const auto& [key, member] : value.members) {
        const std::string place = json_pointer(pointer, key);
        for (const Json* one : member_schemas(key, schema)) {
            if (one == schema.find("additionalProperties") && is_false(*one))
                return SchemaProblem{place, unknown_key(key, keys_of(schema.find("properties")), root)};
            if (Problem problem = find_problem(member, *one, root, place)) return problem;
        }
    }
    for (const std::string& key : strings_of(schema.find("required")))
        if (!value.has(key)) return SchemaProblem{pointer, "missing key " + quote_json(key)};
    return {};
}

Problem items_problem(const Json& value, const Json& schema, const Json& root, const std::string& pointer) {
    const Json *items = schema.find("items"), *additional = schema.find("additionalItems");
    const bool tuple = items && items->kind == Json::Kind::array;
    for (size_t i = 0; i < value.items.size(); ++i) {
        const Json* one = !tuple ? items : i < items->items.size() ? &items->items[i] : additional;
        if (!one) continue;
        if (Problem problem = find_problem(value.items[i], *one, root, json_pointer(pointer, i))) return problem;
    }
    return {};
}

Problem first_of(const Json* schemas, const Json& value, const Json& root, const std::string& pointer) {
    if (schemas)
        for (const Json& one : schemas->items)
            if (Problem problem = find_problem(value, one, root, pointer)) return problem;
    return {};
}

// if / then / else and not.
Problem condition_problem(const Json& value, const Json& schema, const Json& root, const std::string& pointer) {
    const Json *excluded = schema.find("not"), *condition = schema.find("if");
    if (excluded && !find_problem(value, *excluded, root, pointer))
        return SchemaProblem{pointer, "is not allowed here"};
    if (!condition) return {};
    const Json* follows = schema.find(find_problem(value, *condition, root, pointer) ? "else" : "then");
    return follows ? find_problem(value, *follows, root, pointer) : Problem{};
}
}

Problem find_problem(const Json& value, const Json& unresolved, const Json& root, const std::string& pointer) {
    const Json& schema = resolved(unresolved, root);
    if (is_false(schema)) return SchemaProblem{pointer, "is not allowed here"};
    if (const std::string what = value_problem(value, schema); !what.empty())
        return SchemaProblem{pointer, what + meant_value(value, allowed_values(schema), root)};
    Problem problem;
    if (value.kind == Json::Kind::object) problem = members_problem(value, schema, root, pointer);
    if (value.kind == Json::Kind::array) problem = items_problem(value, schema, root, pointer);
    if (!problem) problem = first_of(schema.find("allOf"), value, root, pointer);
    if (!problem) problem = union_problem(value, schema, root, pointer);
    return problem ? problem : condition_problem(value, schema, root, pointer);
}

std::optional<SchemaProblem> schema_problem(const Json& document, const Json& schema) {
    return find_problem(document, schema, schema, "");
}
}
