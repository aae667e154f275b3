#include "modes/settings.h"

#include "base/error.h"
#include "base/text.h"

#include <charconv>
#include <cstdio>

namespace tyndall {
namespace {
std::string short_number(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, static_cast<float>(value)).ptr;
    return std::string(text, end);
}

double parsed_number(std::string_view row, std::string_view text, double low, double high, bool integer) {
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = problem == std::errc() && end == text.data() + text.size();
    if (!whole || !(value >= low && value <= high) || (integer && value != std::floor(value)))
        fail(ExitCode::usage, row,
             "expected " + std::string(integer ? "a whole number" : "a number") + " from " + short_number(low) +
                 " to " + short_number(high) + ", got '" + printable(text, 40) + "'");
    return value;
}

// A row for a number: `field` finds it in the settings.
template<class Field>
SettingRow number_row(std::string name, std::string unit, double low, double high, std::string doc, Field field) {
    using T = std::remove_reference_t<decltype(field(std::declval<Settings&>()))>;
    SettingRow row{name, unit, doc, {}, low, high, std::is_integral_v<T>, {}, {}};
    row.get = [field](const Settings& settings) { return short_number(field(const_cast<Settings&>(settings))); };
    row.set = [field, name, low, high](Settings& settings, std::string_view text) {
        field(settings) = static_cast<T>(parsed_number(name, text, low, high, std::is_integral_v<T>));
    };
    return row;
}

// A row for an enumeration whose values are the positions of `choices`; a bool is {"off", "on"}.
template<class Field>
SettingRow choice_row(std::string name, std::vector<std::string> choices, std::string doc, Field field) {
    using T = std::remove_reference_t<decltype(field(std::declval<Settings&>()))>;
    SettingRow row{name, "", doc, choices, 0, 0, false, {}, {}};
    row.get = [field, choices](const Settings& settings) {
        return choices[static_cast<size_t>(field(const_cast<Settings&>(settings)))];
    };
    row.set = [field, name, choices](Settings& settings, std::string_view text) {
        for (size_t i = 0; i < choices.size(); ++i)
            if (choices[i] == text) return void(field(settings) = static_cast<T>(i));
        fail(ExitCode::usage, name, "expected " + joined(choices, ", ") + "; got '" + printable(text, 40) + "'");
    };
    return row;
}

#define FIELD(member)                                                                                                  \
    [](Settings & settings) -> auto& { return settings.member; }
const std::vector<std::string> switches{"off", "on"};

std::vector<SettingRow> make_rows() {
    return {
        number_row("pixel.samples", "", 1, 4096, "camera rays per pixel", FIELD(pixel.samples)),
        choice_row("pixel.filter", {"box", "tent", "gaussian", "blackman_harris", "center"},
                   "pixel reconstruction filter; center = every sample at the pixel's centre", FIELD(pixel.filter)),
        number_row("pixel.filter_radius", "pixels", 0.25, 4, "how far a sample may lie from the pixel's centre",
                   FIELD(pixel.filter_radius)),
        number_row("march.step_depth", "", 1e-4, 10, "most optical depth one step may cross", FIELD(march.step_depth)),
        number_row("march.step_voxels", "voxels", 0.05, 64, "most voxels one step may cross", FIELD(march.step_voxels)),
        number_row("march.step_length", "m", 1e-5, 1e6, "longest step; shadow detail along the ray needs short ones",
                   FIELD(march.step_length)),
        number_row("march.step_share", "", 1e-5, 1, "longest step as a share of the ray's stretch through fog",
                   FIELD(march.step_share)),
        number_row("march.near_light", "", 0.005, 10, "a step is at most this share of the distance to a local light",
                   FIELD(march.near_light)),
        number_row("march.max_steps", "", 1, 1e6,
                   "most steps per ray; they get longer beyond (slices take all they need)", FIELD(march.max_steps)),
        number_row("march.min_transmittance", "", 0, 0.5, "the march ends where less than this share passes",
                   FIELD(march.min_transmittance)),
        choice_row(
            "march.jitter", {"none", "interleaved"},
            "where in its steps a ray looks: the middle, or shifted from pixel to pixel and sample to sample (slices "
            "need none)",
            FIELD(march.jitter)),
        choice_row(
            "march.visibility", {"off", "rays", "slices"},
            "shadows of surfaces in the fog; rays = sampled at each step, slices = exact: only lit stretches are "
            "integrated, as exactly as the fog allows",
            FIELD(march.visibility)),
        choice_row("march.light", {"off", "average", "grid", "marched"}, "fog between light and fog",
                   FIELD(march.light)),
        number_row("march.light_resolution", "cells", 4, 1024, "cells across the fog in the light's grid",
                   FIELD(march.light_resolution)),
        number_row("march.light_points", "", 1, 256,
                   "points of a soft light that shadows are asked for, by each ray (slices) or step (rays) and by each "
                   "sample of a surface",
                   FIELD(march.light_points)),
        choice_row("march.phase", switches, "directional scattering; off = the same in all directions",
                   FIELD(march.phase)),
        choice_row("march.heterogeneity", switches, "density detail; off = every grid at its mean density",
                   FIELD(march.heterogeneity)),
        choice_row("march.emission", switches, "light the fog itself gives off", FIELD(march.emission)),
        choice_row("march.ambient", switches, "the scene's ambient light in the fog", FIELD(march.ambient)),
        number_row("path.orders", "", 1, all_orders, "most times light scatters, in fog or on surfaces; 1 = once",
                   FIELD(path.orders)),
        choice_row("path.emission", switches, "light that fog and surfaces give off", FIELD(path.emission)),
        choice_row("path.ambient", switches, "the scene's ambient light, as even surroundings far away",
                   FIELD(path.ambient)),
    };
}
#undef FIELD
}

const std::vector<SettingRow>& setting_rows() {
    static const std::vector<SettingRow> rows = make_rows();
    return rows;
}

void apply_setting(Settings& settings, std::string_view assignment) {
    const size_t equals = assignment.find('=');
    if (equals == std::string_view::npos)
        fail(ExitCode::usage, "--set", "expected row=value, got '" + printable(assignment, 60) + "'");
    const std::string_view name = assignment.substr(0, equals);
    std::vector<std::string> names;
    for (const SettingRow& row : setting_rows()) {
        if (row.name == name) return row.set(settings, assignment.substr(equals + 1));
        names.push_back(row.name);
    }
    fail(ExitCode::usage, "--set",
         "no setting '" + printable(name, 60) + "'; did you mean " + nearest_name(name, names) +
             "? (tyndall modes lists them)");
}

Settings settings_for(Quality quality) {
    Settings settings;
    MarchSettings& march = settings.march;
    switch (quality) {
    case Quality::draft:
        settings.pixel.samples = 1;
        march.step_depth = 0.5f, march.step_voxels = 16, march.step_share = 1.0f / 24, march.near_light = 1;
        march.min_transmittance = 1e-2f, march.light_resolution = 32;
        break;
    case Quality::preview:
        break;
    case Quality::final:
        settings.pixel.samples = 16;
        march.step_depth = 0.1f, march.step_voxels = 2, march.step_share = 1.0f / 96, march.near_light = 0.25f;
        march.max_steps = 4096, march.min_transmittance = 1e-4f, march.light_resolution = 128;
        break;
    case Quality::reference:
        settings.pixel.samples = 64;
        march.step_depth = 0.1f, march.step_voxels = 2, march.step_share = 1.0f / 64, march.near_light = 0.02f;
        march.max_steps = 65536, march.min_transmittance = 0, march.light = LightTransmittance::marched;
        march.visibility = Visibility::slices;
        march.light_resolution = 256;
        break;
    }
    return settings;
}

std::string_view name_of(Quality quality) {
    constexpr std::string_view names[] = {"draft", "preview", "final", "reference"};
    return names[static_cast<size_t>(quality)];
}

Quality quality_named(std::string_view name) {
    for (const Quality quality : {Quality::draft, Quality::preview, Quality::final, Quality::reference})
        if (name_of(quality) == name) return quality;
    fail(ExitCode::usage, "--quality",
         "expected draft, preview, final or reference; got '" + printable(name, 40) + "'");
}
}
