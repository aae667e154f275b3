// Checks documents against a JSON schema and reports the first problem in one sentence.
#include "base/error.h"
#include "base/json/json.h"
#include "base/json/json_pointer.h"
#include "base/json/schema_problem.h"

namespace tyndall {
namespace {
// std::regex recurses for every character, so long strings could overflow the stack.
constexpr size_t longest_string = 10000;

void check_string(const std::string& text, const std::string& pointer, std::string_view file) {
    if (text.size() > longest_string)
        refuse(json_location(file, pointer), "a string of " + std::to_string(text.size()) + " bytes; at most " +
                                                 std::to_string(longest_string) + " are allowed");
}

void check_strings(const Json& value, const std::string& pointer, std::string_view file) {
    check_string(value.string, pointer, file);
    for (size_t i = 0; i < value.items.size(); ++i) check_strings(value.items[i], json_pointer(pointer, i), file);
    for (const auto& [key, member] : value.members) {
        check_string(key, pointer, file);
        check_strings(member, json_pointer(pointer, key), file);
    }
}

}

void check_schema(const Json& document, std::string_view schema_text, std::string_view file) {
    check_strings(document, "", file);
    if (const auto problem = schema_problem(document, parse_json(schema_text, "schema")))
        refuse(json_location(file, problem->pointer), problem->what);
}
}
