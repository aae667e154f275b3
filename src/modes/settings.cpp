#include "modes/settings_rows.h"

#include "base/error.h"
#include "base/text.h"

#include <charconv>
#include <cstdio>

namespace tyndall {
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

size_t parsed_choice(std::string_view row, std::string_view text, const std::vector<std::string>& choices) {
    for (size_t i = 0; i < choices.size(); ++i)
        if (choices[i] == text) return i;
    fail(ExitCode::usage, row, "expected " + joined(choices, ", ") + "; got '" + printable(text, 40) + "'");
}

const std::vector<SettingRow>& setting_rows() {
    static const std::vector<SettingRow> rows = [] {
        std::vector<SettingRow> all;
        append_pixel_rows(all);
        append_style_rows(all);
        append_march_rows(all);
        append_fluence_rows(all);
        append_froxel_rows(all);
        append_shadow_map_rows(all);
        append_shadow_volume_rows(all);
        append_cone_rows(all);
        append_billboard_rows(all);
        append_radial_blur_rows(all);
        append_path_rows(all);
        return all;
    }();
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
    ShadowVolumeSettings& volume = settings.shadow_volume;
    FroxelSettings& froxel = settings.froxel;
    ShadowMapSettings& map = settings.shadow_map;
    switch (quality) {
    case Quality::draft:
        settings.pixel.samples = 1, settings.pixel.lamp_samples = 1;
        settings.cone.nodes = 6;
        march.step_depth = 0.5f, march.step_voxels = 16, march.step_share = 1.0f / 24, march.near_light = 1;
        march.min_transmittance = 1e-2f, march.light_resolution = 32, march.light = LightTransmittance::froxel;
        march.nodes = 3;
        volume.nodes = 3, volume.steps = 16, volume.light_resolution = 32;
        froxel.tile = 16, froxel.depth_slices = 48;
        settings.fluence.resolution = 32, settings.fluence.paths = 50'000;
        map.steps = 16, map.resolution = 256;
        break;
    case Quality::preview:
        break;
    case Quality::final:
        settings.pixel.samples = 16, settings.pixel.lamp_samples = 64;
        march.step_depth = 0.1f, march.step_voxels = 2, march.step_share = 1.0f / 96, march.near_light = 0.25f;
        march.max_steps = 4096, march.min_transmittance = 1e-4f, march.light_resolution = 128, march.nodes = 6;
        volume.nodes = 6, volume.steps = 128, volume.light_resolution = 128;
        froxel.tile = 2, froxel.depth_slices = 160, froxel.shadow_rays = 4;
        settings.fluence.resolution = 96, settings.fluence.paths = 1'000'000;
        map.steps = 64, map.resolution = 2048, map.pcf = 1;
        break;
    case Quality::reference:
        settings.pixel.samples = 64, settings.pixel.lamp_samples = 64;
        settings.cone.nodes = 16;
        march.step_depth = 0.1f, march.step_voxels = 2, march.step_share = 1.0f / 64, march.near_light = 0.02f;
        march.max_steps = 65536, march.min_transmittance = 0, march.light = LightTransmittance::marched;
        march.visibility = Visibility::exact;
        march.light_resolution = 256, march.nodes = 16;
        volume.nodes = 16, volume.steps = 1024, volume.light_resolution = 256;
        froxel.tile = 1, froxel.depth_slices = 768, froxel.shadow_rays = 16;
        settings.fluence.resolution = 128, settings.fluence.paths = 4'000'000;
        map.steps = 256, map.resolution = 4096, map.pcf = 1, map.light = LightTransmittance::marched;
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
