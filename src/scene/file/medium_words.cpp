#include "scene/file/medium_words.h"

#include "base/error.h"
#include "base/json/json.h"
#include "base/text.h"
#include "base/utf8.h"
#include "scene/file/scene_words.h"
#include "volume/bricks/half.h"

#include <algorithm>
#include <utility>

namespace tyndall {
namespace {
constexpr float hottest = 2000;  // kelvin, for the maximum of a grid that is not in kelvin: the yellow of a wood fire
constexpr float in_kelvin = 500; // grids with larger values are taken to be in kelvin

// Whether a scene file can name the grid.
bool can_be_named(const VdbGridInfo& grid) {
    std::string_view rest = grid.key;
    while (const size_t length = utf8_length(rest)) rest.remove_prefix(length);
    return rest.empty();
}

// The first non-empty grid of a role with values above 0.
const VdbGridInfo* grid_like(const VdbInfo& info, GridRole role) {
    const auto found = std::ranges::find_if(info.grids, [&](const VdbGridInfo& grid) {
        return grid.role == role && grid.active_voxels > 0 && grid.maximum > 0 && can_be_named(grid);
    });
    return found == info.grids.end() ? nullptr : &*found;
}

// Whether a simulation of fire left its flames at 0.
bool is_without_flames(const VdbInfo& info) {
    return std::ranges::count(info.grids, GridRole::flame, &VdbGridInfo::role) > 0 && !grid_like(info, GridRole::flame);
}

// A number to three significant digits, in the usual notation without exponents.
std::string digits(float value) {
    return json_number(parsed<float>(formatted("%.3g", static_cast<double>(value))).value_or(0));
}

std::string member(const std::string& name, const std::string& value) { return quote_json(name) + ": " + value; }

// A color in three grids is named by the common part of their names.
std::string color_name(const VdbGridInfo& grid) {
    const size_t dot = grid.name.rfind('.');
    return quote_json(grid.ranges.empty() && dot != std::string::npos ? grid.name.substr(0, dot) : grid.key);
}

std::string temperature_text(const VdbGridInfo& grid) {
    if (grid.maximum > in_kelvin) return quote_json(grid.key);
    return "{" + member("grid", quote_json(grid.key)) + ", " + member("scale", digits(hottest / grid.maximum)) + "}";
}

// How deep inside the distances of a level set are known: half its narrow band, or where it keeps every distance, to
// the least one.
float known_depth(const VdbGridInfo& grid) {
    return grid.background > 0 ? grid.background : std::max(-grid.minimum, 0.0f);
}

// The density grid, or a level set with the width of its falloff.
std::string density_text(const VdbGridInfo& grid) {
    if (grid.role != GridRole::level_set) return quote_json(grid.key);
    return "{" + member("grid", quote_json(grid.key)) + ", " + member("width", digits(0.5f * known_depth(grid))) + "}";
}

const VdbGridInfo* density_of(const VdbInfo& info) {
    for (const VdbGridInfo& grid : info.grids)
        if (grid.is_fog) return &grid;
    const VdbGridInfo* level_set = grid_like(info, GridRole::level_set);
    return level_set && known_depth(*level_set) > 0 ? level_set : nullptr;
}

const VdbGridInfo* velocity_of(const VdbInfo& info) {
    const auto found = std::ranges::find_if(info.grids, [](const VdbGridInfo& grid) {
        return grid.role == GridRole::velocity && grid.active_voxels > 0 && can_be_named(grid);
    });
    return found == info.grids.end() ? nullptr : &*found;
}
}

bool states_extinction(const VdbInfo& info) {
    return std::ranges::any_of(info.metadata,
                               [](const auto& entry) { return entry.first == "tyndall_extinction_per_m"; });
}

float default_extinction(const VdbGridInfo& fog) {
    const Box voxels{vec3(fog.active_low) - 0.5f, vec3(fog.active_high) + 0.5f};
    const float diagonal = std::max(glm::length(transform(mat4(fog.index_to_world), voxels).size()), 1e-3f);
    constexpr float stray = 1e30f; // a voxel above is damaged, and is clamped where others are not as large
    const float highest = fog.maximum > stray ? largest_half : fog.maximum;
    return 4 / (diagonal * (fog.role == GridRole::level_set ? 1.0f : highest));
}

std::string medium_text(const std::filesystem::path& vdb, const VdbInfo& info) {
    const VdbGridInfo *density = density_of(info), *color = grid_like(info, GridRole::color),
                      *temperature = grid_like(info, GridRole::temperature), *flame = grid_like(info, GridRole::flame);
    const bool dims = density && density->maximum > 0;
    if (!temperature) temperature = std::exchange(flame, nullptr); // a flame grid serves as the temperature
    if (dims && temperature && temperature->maximum <= in_kelvin && is_without_flames(info))
        temperature = nullptr; // the heat that makes smoke rise
    const VdbGridInfo* emission = temperature ? nullptr : grid_like(info, GridRole::emission);
    if (!density && !temperature && !emission) return {};
    std::vector<std::string> grids;
    if (dims && can_be_named(*density)) grids.push_back(member("density", density_text(*density)));
    if (dims && color) grids.push_back(member("albedo", color_name(*color)));
    if (temperature) grids.push_back(member("temperature", temperature_text(*temperature)));
    if (flame) grids.push_back(member("flame", quote_json(flame->key)));
    if (emission) grids.push_back(member("emission", color_name(*emission)));
    if (const VdbGridInfo* velocity = velocity_of(info)) grids.push_back(member("velocity", color_name(*velocity)));
    std::string text =
        "{" + member("type", "\"vdb\"") + ", " + member("file", quote_json(vdb.filename().string())) +
        (states_extinction(info) ? "" : ", " + member("extinction", dims ? digits(default_extinction(*density)) : "0"));
    if (!grids.empty()) text += ", " + member("grids", "{" + joined(grids, ", ") + "}");
    if (temperature) text += ", " + member("blackbody", "{\"convention\": \"kelvin\", \"emission_scale\": 1}");
    return text + "}";
}

std::string velocity_text(const std::filesystem::path& vdb, const VdbInfo& info) {
    const VdbGridInfo* velocity = velocity_of(info);
    if (!velocity || !medium_text(vdb, info).empty()) return {};
    return "{" +
           member("velocity", "{" + member("file", quote_json(vdb.filename().string())) + ", " +
                                  member("grid", color_name(*velocity)) + "}") +
           "}";
}
}
