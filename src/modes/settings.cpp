#include "modes/mode.h"
#include "modes/settings_rows.h"

#include "base/error.h"
#include "base/text.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
std::string short_number(double value) { return shortest_text(static_cast<float>(value)); }

double parsed_number(std::string_view row, std::string_view text, double low, double high, bool integer) {
    const auto value = parsed<double>(text);
    if (!value || !(*value >= low && *value <= high) || (integer && *value != std::floor(*value)))
        fail(ExitCode::usage, row,
             "expected " + std::string(integer ? "a whole number" : "a number") + " from " + short_number(low) +
                 " to " + short_number(high) + ", got '" + printable(text, 40) + "'");
    return *value;
}

vec3 parsed_color(std::string_view row, std::string_view text, double low, double high) {
    const size_t first = text.find(','), second = first == text.npos ? first : text.find(',', first + 1);
    if (second == text.npos)
        fail(ExitCode::usage, row, "expected three numbers as R,G,B; got '" + printable(text, 40) + "'");
    const auto part = [&](std::string_view number) {
        return static_cast<float>(parsed_number(row, number, low, high, false));
    };
    return {part(text.substr(0, first)), part(text.substr(first + 1, second - first - 1)),
            part(text.substr(second + 1))};
}

void mark_advanced(std::vector<SettingRow>& rows, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) {
        const auto ends = [&](const SettingRow& row) { return row.name.substr(row.name.find('.') + 1) == name; };
        const auto last = std::find_if(rows.rbegin(), rows.rend(), ends); // the technique's own rows come last
        assert(last != rows.rend());
        last->advanced = true;
    }
}

const std::vector<SettingRow>& setting_rows() {
    static const std::vector<SettingRow> rows = [] {
        std::vector<SettingRow> all;
        append_pixel_rows(all);
        append_term_rows(all);
        append_fluence_rows(all);
        append_style_rows(all);
        for (const Mode& mode : modes())
            if (mode.append_rows) mode.append_rows(all);
        return all;
    }();
    return rows;
}

const SettingRow& find_row(std::string_view name, std::string_view where) {
    std::vector<std::string> names;
    for (const SettingRow& row : setting_rows()) {
        if (row.name == name) return row;
        names.push_back(row.name);
    }
    fail(ExitCode::usage, where, unknown_name("setting", name, names) + " (tyndall modes --settings lists them)");
}

bool same_settings(const Settings& a, const Settings& b) {
    return std::ranges::all_of(setting_rows(), [&](const SettingRow& row) { return row.get(a) == row.get(b); });
}

void apply_setting(Settings& settings, std::string_view assignment) {
    const size_t equals = assignment.find('=');
    if (equals == std::string_view::npos)
        fail(ExitCode::usage, "--set", "expected row=value, got '" + printable(assignment, 60) + "'");
    find_row(assignment.substr(0, equals)).set(settings, assignment.substr(equals + 1));
}

Settings settings_for(Quality quality) {
    Settings settings;
    PixelSettings& pixel = settings.pixel;
    FluenceSettings& fluence = settings.fluence;
    switch (quality) {
    case Quality::draft:
        pixel.samples = 1, pixel.lamp_samples = 1;
        fluence.resolution = 32, fluence.paths = 50'000;
        break;
    case Quality::preview:
        break;
    case Quality::final:
        pixel.samples = 16, pixel.lamp_samples = 64;
        fluence.resolution = 96, fluence.paths = 1'000'000;
        break;
    case Quality::reference:
        pixel.samples = 64, pixel.lamp_samples = 64;
        fluence.resolution = 128, fluence.paths = 4'000'000;
        break;
    }
    set_term_quality(settings.terms, quality);
    for (const Mode& mode : modes())
        if (mode.set_quality) mode.set_quality(settings, quality);
    return settings;
}

std::string_view name_of(Quality quality) {
    constexpr std::string_view names[] = {"draft", "preview", "final", "reference"};
    return names[static_cast<size_t>(quality)];
}

Quality quality_named(std::string_view name) {
    return static_cast<Quality>(choice_among("--quality", name, {"draft", "preview", "final", "reference"}));
}
}
