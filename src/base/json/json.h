// Safe JSON input: parsed with limits, checked against a schema, then accessed as a plain tree of values.
// An error names the file, the JSON pointer and what was expected.
#pragma once
#include "base/math.h"

#include <cmath>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace tyndall {
class Json {
public:
    enum class Kind { null, boolean, number, string, array, object };

    Kind kind = Kind::null;
    bool boolean = false;
    double number = 0;
    std::string string;
    std::vector<Json> items;                           // of an array
    std::vector<std::pair<std::string, Json>> members; // of an object, in file order

    Json() = default;
    template<class T>
    requires std::is_arithmetic_v<T> Json(T value) { // null if infinite or NaN
        const double wide = static_cast<double>(value);
        kind = std::is_same_v<T, bool> ? Kind::boolean : std::isfinite(wide) ? Kind::number : Kind::null;
        if constexpr (std::is_same_v<T, bool>)
            boolean = value;
        else
            number = wide;
    }
    template<class T>
    requires std::convertible_to<T, std::string_view> Json(const T& text)
        : kind(Kind::string), string(std::string_view(text)) {}
    template<class T> Json(const std::vector<T>& values) : kind(Kind::array), items(values.begin(), values.end()) {}
    Json(ivec2 v) : Json(std::vector{v.x, v.y}) {}
    Json(vec3 v) : Json(std::vector{v.x, v.y, v.z}) {}
    Json(const Box& box); // {low, high}; null if empty

    const Json* find(std::string_view key) const; // member of an object, or null
    bool has(std::string_view key) const { return find(key) != nullptr; }
    // The value of a member, or `otherwise` if it is absent. The schema check has already verified type and range.
    double number_or(std::string_view key, double otherwise) const;
    bool boolean_or(std::string_view key, bool otherwise) const;
    std::string string_or(std::string_view key, std::string_view otherwise) const;
};

// Parses text (comments allowed; duplicate keys, depth over 64, non-finite numbers and more than `max_values` values
// refused). Throws Error (refused).
Json parse_json(std::string_view text, std::string_view file, size_t max_values = size_t{1} << 20);

// Checks a document against a schema (draft-07). Throws Error (refused) naming the file, the JSON pointer and what was
// expected, with the nearest known name as a hint for an unknown key.
void check_schema(const Json& document, std::string_view schema_text, std::string_view file);

// Reads, parses and checks a file.
Json read_json(const std::filesystem::path& path, std::string_view schema_text);

// Compact JSON text of a value; numbers in the shortest form that round-trips.
std::string format_json(const Json& value);
std::string quote_json(std::string_view text);
}
