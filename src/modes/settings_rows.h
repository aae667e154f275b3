// How a technique describes its settings as named rows. For settings.cpp of each technique.
#pragma once
#include "base/text.h"
#include "modes/settings.h"

#include <type_traits>

namespace tyndall {
// A number as --set reads it, and the shortest text that reads back as the same float. Throws Error (usage).
double parsed_number(std::string_view row, std::string_view text, double low, double high, bool integer);
std::string short_number(double value);

vec3 parsed_color(std::string_view row, std::string_view text, double low, double high);

// A row for a number: `field` returns a reference to it in the settings.
template<class Field>
SettingRow number_row(std::string name, std::string unit, double low, double high, std::string doc, Field field) {
    using T = std::remove_reference_t<decltype(field(std::declval<Settings&>()))>;
    SettingRow row{name, unit, doc, {}, low, high, std::is_integral_v<T>};
    row.get = [field](const Settings& settings) { return short_number(field(const_cast<Settings&>(settings))); };
    row.set = [field, name, low, high](Settings& settings, std::string_view text) {
        field(settings) = static_cast<T>(parsed_number(name, text, low, high, std::is_integral_v<T>));
    };
    return row;
}

// A row for an enumeration whose values index `choices`; a bool is {"off", "on"}.
template<class Field>
SettingRow choice_row(std::string name, std::vector<std::string> choices, std::string doc, Field field) {
    using T = std::remove_reference_t<decltype(field(std::declval<Settings&>()))>;
    SettingRow row{name, "", doc, choices};
    row.get = [field, choices](const Settings& settings) {
        return choices[static_cast<size_t>(field(const_cast<Settings&>(settings)))];
    };
    row.set = [field, name, choices](Settings& settings, std::string_view text) {
        field(settings) = static_cast<T>(choice_among(name, text, choices));
    };
    return row;
}

// A row for a color: three comma-separated numbers.
template<class Field>
SettingRow color_row(std::string name, std::string unit, double low, double high, std::string doc, Field field) {
    SettingRow row{name, unit, doc, {}, low, high};
    row.parts = 3;
    row.get = [field](const Settings& settings) {
        const vec3 v = field(const_cast<Settings&>(settings));
        return short_number(v.x) + "," + short_number(v.y) + "," + short_number(v.z);
    };
    row.set = [field, name, low, high](Settings& settings, std::string_view text) {
        field(settings) = parsed_color(name, text, low, high);
    };
    return row;
}

// Marks rows, named without their prefix, as advanced.
void mark_advanced(std::vector<SettingRow>& rows, std::initializer_list<std::string_view> names);

#define TYNDALL_FIELD(member)                                                                                          \
    [](Settings & settings) -> auto& { return settings.member; }
inline const std::vector<std::string> switches{"off", "on"};
inline const std::vector<std::string> resolutions{"full", "half", "third", "quarter"};

// The rows that techniques share.
void append_pixel_rows(std::vector<SettingRow>& rows);
void append_term_rows(std::vector<SettingRow>& rows);
void append_style_rows(std::vector<SettingRow>& rows);
void append_fluence_rows(std::vector<SettingRow>& rows);

void set_term_quality(TermSettings& terms, Quality quality);
}
