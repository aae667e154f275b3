// valijson gives the verdict; the sentence comes from our own walk over the schema.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized" // GCC 12 warns of <regex> itself under sanitizers
#define VALIJSON_USE_EXCEPTIONS 1
#include "base/error.h"
#include "base/io/json.h"
#include "base/io/json_pointer.h"
#include "base/io/schema_problem.h"

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include <cmath>

namespace tyndall {
namespace {
using valijson::adapters::NlohmannJsonAdapter;

// The recursive matcher of std::regex needs stack for every character.
constexpr size_t longest_string = 10000;

// Whole numbers become integers, so that 2.0 is one.
nlohmann::json converted_number(double number) {
    const bool whole = number == std::floor(number) && std::fabs(number) <= 0x1p53;
    return whole ? nlohmann::json(static_cast<int64_t>(number)) : nlohmann::json(number);
}

nlohmann::json converted(const Json& value) {
    nlohmann::json result;
    switch (value.kind) {
    case Json::Kind::null:
        break;
    case Json::Kind::boolean:
        result = value.boolean;
        break;
    case Json::Kind::number:
        result = converted_number(value.number);
        break;
    case Json::Kind::string:
        result = value.string;
        break;
    case Json::Kind::array:
        result = nlohmann::json::array();
        for (const Json& item : value.items) result.push_back(converted(item));
        break;
    case Json::Kind::object:
        result = nlohmann::json::object();
        for (const auto& [key, member] : value.members) result[key] = converted(member);
        break;
    }
    return result;
}

void check_string(const std::string& text, const std::string& pointer, std::string_view file) {
    if (text.size() > longest_string)
        refuse(json_place(file, pointer), "a text of " + std::to_string(text.size()) + " bytes; at most " +
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

// What valijson says of its innermost error, for the keywords our walk does not know.
[[noreturn]] void refuse_with_library_message(const valijson::ValidationResults& results, std::string_view file) {
    std::string pointer, what = "does not fit the schema";
    for (const auto& error : results) {
        std::string place;
        for (size_t i = 1; i < error.context.size(); ++i) // "<root>", then "[key]" each
            place = json_pointer(place, std::string_view(error.context[i]).substr(1, error.context[i].size() - 2));
        if (place.size() >= pointer.size()) pointer = place, what = error.description;
    }
    refuse(json_place(file, pointer), what);
}
}

void check_schema(const Json& document, std::string_view schema_text, std::string_view file) {
    check_strings(document, "", file);
    const Json schema = parse_json(schema_text, "schema");
    const nlohmann::json rules = converted(schema), values = converted(document);
    valijson::Schema parsed;
    valijson::SchemaParser().populateSchema(NlohmannJsonAdapter(rules), parsed);
    valijson::Validator validator;
    if (validator.validate(parsed, NlohmannJsonAdapter(values), nullptr)) return;

    if (const auto problem = schema_problem(document, schema))
        refuse(json_place(file, problem->pointer), problem->what);
    valijson::ValidationResults results;
    validator.validate(parsed, NlohmannJsonAdapter(values), &results);
    refuse_with_library_message(results, file);
}
}
