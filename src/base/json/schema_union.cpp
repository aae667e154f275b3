#include "base/json/schema_union.h"

#include "base/json/json_pointer.h"
#include "base/text.h"

#include <algorithm>
#include <cctype>

namespace tyndall {
namespace {
std::string lowered(std::string_view text) { return lower_case(std::string(text.substr(0, 64))); }

// A typo is assumed to keep at least two thirds of the letters.
bool looks_like(std::string_view a, std::string_view b) {
    std::string rest = lowered(b);
    const size_t longest = std::max(a.size(), b.size());
    size_t shared = 0;
    for (const char c : lowered(a)) {
        const size_t at = rest.find(c);
        if (at == std::string::npos) continue;
        rest.erase(at, 1);
        ++shared;
    }
    return 3 * shared >= 2 * longest;
}
}

namespace {
// Letters and digits only, so that outerConeAngle and outer_cone_angle compare equal.
std::string bare(std::string_view text) {
    std::string word = lowered(text);
    std::erase_if(word, [](unsigned char c) { return !std::isalnum(c); });
    return word;
}

// The names that list `word` as a synonym from other programs.
std::vector<std::string> meant_by(std::string_view word, const std::vector<std::string>& names, const Json& root) {
    const Json* synonyms = root.find("synonyms");
    std::vector<std::string> meant;
    for (const std::string& name : names)
        for (const std::string& synonym : strings_of(synonyms ? synonyms->find(name) : nullptr))
            if (bare(synonym) == bare(word)) meant.push_back(quote_json(name));
    return meant;
}
}

std::string meant_value(const Json& value, const std::vector<const Json*>& allowed, const Json& root) {
    std::vector<std::string> names;
    for (const Json* one : allowed) names.push_back(one->string);
    const std::vector<std::string> meant = meant_by(value.string, names, root);
    return meant.empty() ? "" : "; did you mean " + joined(meant, " or ") + "?";
}

std::string unknown_key(const std::string& key, const std::vector<std::string>& known, const Json& root) {
    if (known.empty()) return "unknown key; no keys are allowed here";
    if (const auto meant = meant_by(key, known, root); !meant.empty())
        return "unknown key; did you mean " + joined(meant, " or ") + "?";
    const auto longer_form = [wanted = lowered(key)](const std::string& name) {
        const bool at_end =
            name.size() > wanted.size() && name.ends_with(wanted) && name[name.size() - wanted.size() - 1] == '_';
        return wanted.size() >= 3 && (name.starts_with(wanted) || at_end);
    };
    if (const auto match = std::find_if(known.begin(), known.end(), longer_form); match != known.end())
        return "unknown key; did you mean " + quote_json(*match) + "?";
    const std::string nearest = nearest_name(lowered(key), known);
    if (looks_like(key, nearest)) return "unknown key; did you mean " + quote_json(nearest) + "?";
    return "unknown key; allowed here: " + quoted_list(known);
}

namespace {
// One alternative of a union, and why it does not fit.
struct Branch {
    const Json* schema;
    Problem problem;
};

// Types that a schema allows, including through nested unions; empty if any type is allowed.
std::vector<std::string> types_of(const Json& schema, const Json& root) {
    std::vector<std::string> types = allowed_types(schema);
    if (!types.empty()) return types;
    for (const char* keyword : {"oneOf", "anyOf"})
        if (const Json* branches = schema.find(keyword)) {
            for (const Json& branch : branches->items) {
                const auto more = types_of(resolved(branch, root), root);
                if (more.empty()) return {};
                types.insert(types.end(), more.begin(), more.end());
            }
        }
    return types;
}

bool fits_types(const Json& value, const std::vector<std::string>& types) {
    return types.empty() ||
           std::any_of(types.begin(), types.end(), [&](const auto& type) { return has_type(value, type); });
}

// The values that a branch allows for one member; empty if the member is unrestricted.
std::vector<const Json*> allowed_for(const Branch& branch, const std::string& key, const Json& root) {
    const Json* properties = branch.schema->find("properties");
    const Json* member = properties ? properties->find(key) : nullptr;
    return member ? allowed_values(resolved(*member, root)) : std::vector<const Json*>{};
}

bool contains(const std::vector<const Json*>& allowed, const Json& value) {
    return std::any_of(allowed.begin(), allowed.end(), [&](const Json* one) { return equal(*one, value); });
}

// True if all branches require the member, so that its absence is itself a problem.
bool all_require(const std::vector<Branch>& branches, const std::string& key) {
    return std::all_of(branches.begin(), branches.end(), [&](const Branch& branch) {
        const std::vector<std::string> required = strings_of(branch.schema->find("required"));
        return std::find(required.begin(), required.end(), key) != required.end();
    });
}

// Keeps the branches whose discriminator ("type": "spot") matches the value; returns a problem if none does.
Problem narrow_by_member(const Json& value, std::vector<Branch>& branches, const Json& root,
                         const std::string& pointer) {
    for (const std::string& key : keys_of(branches.front().schema->find("properties"))) {
        std::vector<const Json*> allowed;
        const auto restricts = [&](const Branch& branch) {
            const auto here = allowed_for(branch, key, root);
            allowed.insert(allowed.end(), here.begin(), here.end());
            return !here.empty();
        };
        if (!std::all_of(branches.begin(), branches.end(), restricts)) continue;

        if (const Json* member = value.find(key)) {
            if (!contains(allowed, *member))
                return SchemaProblem{json_pointer(pointer, key),
                                     expected_values(allowed, member) + meant_value(*member, allowed, root)};
            std::erase_if(branches,
                          [&](const auto& branch) { return !contains(allowed_for(branch, key, root), *member); });
        } else if (all_require(branches, key)) {
            for (const auto& other : value.members)
                if (contains(allowed, other.second) && looks_like(other.first, key))
                    return SchemaProblem{json_pointer(pointer, other.first), unknown_key(other.first, {key}, root)};
            return SchemaProblem{pointer, "missing key " + quote_json(key) + "; " + expected_values(allowed)};
        }
    }
    return {};
}

// How well an object matches a branch: plus one for every known key, minus one for every unknown key.
int likeness(const Json& value, const Branch& branch) {
    const Json* properties = branch.schema->find("properties");
    int score = 0;
    for (const auto& member : value.members) score += properties && properties->has(member.first) ? 1 : -1;
    return score;
}

bool only_requires(const Json& schema) { return schema.members.size() == 1 && schema.has("required"); }

// "needs one of "color", "sky"" if every alternative only requires keys; else empty.
std::string required_choice(const std::vector<Branch>& branches, const char* text) {
    std::vector<std::string> keys;
    for (const Branch& branch : branches) {
        if (!only_requires(*branch.schema)) return {};
        const auto more = strings_of(branch.schema->find("required"));
        keys.insert(keys.end(), more.begin(), more.end());
    }
    return text + quoted_list(keys);
}

// Of several alternatives that all fail, the problem of the one most likely meant.
Problem likeliest_problem(const Json& value, std::vector<Branch> branches, const Json& root,
                          const std::string& pointer) {
    std::vector<std::string> types;
    for (const Branch& branch : branches)
        for (const std::string& type : types_of(*branch.schema, root)) types.push_back(type);
    std::erase_if(branches, [&](const Branch& branch) { return !fits_types(value, types_of(*branch.schema, root)); });
    if (branches.empty()) return SchemaProblem{pointer, expected_types(types, value)};

    std::vector<const Json*> allowed;
    const auto lists_values = [&](const Branch& branch) {
        const auto here = allowed_values(*branch.schema);
        allowed.insert(allowed.end(), here.begin(), here.end());
        return !here.empty();
    };
    if (std::all_of(branches.begin(), branches.end(), lists_values))
        return SchemaProblem{pointer, expected_values(allowed, &value) + meant_value(value, allowed, root)};
    if (const std::string what = required_choice(branches, "needs one of "); !what.empty())
        return SchemaProblem{pointer, what};
    if (value.kind == Json::Kind::object && branches.size() > 1)
        if (Problem problem = narrow_by_member(value, branches, root, pointer)) return problem;
    const auto lists_other_kinds = [&](const Branch& branch) { // names where the value is an array
        const auto here = allowed_values(*branch.schema);
        return !here.empty() && std::ranges::none_of(here, [&](const Json* one) { return one->kind == value.kind; });
    };
    if (!std::ranges::all_of(branches, lists_other_kinds)) std::erase_if(branches, lists_other_kinds);

    const auto better = [&](const Branch& a, const Branch& b) {
        const int like_a = likeness(value, a), like_b = likeness(value, b);
        return like_a != like_b ? like_a < like_b : a.problem->pointer.size() < b.problem->pointer.size();
    };
    return std::max_element(branches.begin(), branches.end(), better)->problem;
}
}

Problem union_problem(const Json& value, const Json& schema, const Json& root, const std::string& pointer) {
    for (const char* keyword : {"anyOf", "oneOf"}) {
        const Json* alternatives = schema.find(keyword);
        if (!alternatives) continue;
        std::vector<Branch> failing, fitting;
        for (const Json& one : alternatives->items) {
            Branch branch{&resolved(one, root), find_problem(value, one, root, pointer)};
            (branch.problem ? failing : fitting).push_back(std::move(branch));
        }
        if (fitting.empty()) return likeliest_problem(value, std::move(failing), root, pointer);
        if (fitting.size() == 1 || keyword == std::string_view("anyOf")) continue;
        const std::string what = required_choice(fitting, "takes only one of ");
        return SchemaProblem{pointer, what.empty() ? "matches more than one of the allowed forms" : what};
    }
    return {};
}
}
