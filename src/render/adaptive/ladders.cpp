#include "render/adaptive/ladders.h"

#include "modes/techniques.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>

namespace tyndall {
namespace {
// What a rung of the march decides.
constexpr std::array<std::string_view, 10> march_rows{
    "march.step_depth",        "march.step_voxels", "march.step_share", "march.near_light", "march.max_steps",
    "march.min_transmittance", "march.visibility",  "march.light",      "march.nodes",      "march.light_resolution"};

struct MarchRung {
    const char* name;
    int samples; // grow with care, so that the edges of surfaces do not hide what the fog gains
    MarchSettings march;
};

// Steps and light grids get finer together, since neither alone is the whole error.
std::vector<MarchRung> march_rungs() {
    const auto of = [](Quality quality) { return settings_for(quality).march; };
    MarchSettings fine = of(Quality::preview), finer = of(Quality::final), marched;
    fine.step_depth = 0.15f, fine.step_voxels = 4, fine.step_share = 1.0f / 56, fine.near_light = 0.35f;
    fine.max_steps = 2048, fine.min_transmittance = 3e-4f, fine.light_resolution = 96, fine.nodes = 5;
    finer.step_depth = 0.05f, finer.step_voxels = 1, finer.step_share = 1.0f / 192, finer.near_light = 0.125f;
    finer.max_steps = 16384, finer.min_transmittance = 1e-5f, finer.light_resolution = 256, finer.nodes = 8;
    marched = finer, marched.light = LightTransmittance::marched;
    return {{"draft", 1, of(Quality::draft)},
            {"preview", 1, of(Quality::preview)},
            {"fine", 4, fine},
            {"final", 16, of(Quality::final)},
            {"finer", 32, finer},
            {"marched", 64, marched},
            {"exact", 64, of(Quality::reference)}};
}

constexpr std::string_view shadow_map_rungs[] = {
    "pixel.samples=1 shadow_map.steps=8 shadow_map.resolution=256 march.light_resolution=32",
    "pixel.samples=1 shadow_map.steps=16 shadow_map.resolution=256 march.light_resolution=32",
    "pixel.samples=2 shadow_map.steps=24 shadow_map.resolution=512 march.light_resolution=64",
    "pixel.samples=4 shadow_map.steps=48 shadow_map.resolution=1024 shadow_map.pcf=1 march.light_resolution=64",
    "pixel.samples=16 shadow_map.steps=64 shadow_map.resolution=2048 shadow_map.pcf=1 march.light_resolution=128",
    "pixel.samples=64 shadow_map.steps=128 shadow_map.resolution=4096 shadow_map.pcf=1 march.light_resolution=192"};

constexpr std::string_view froxel_rungs[] = {
    "pixel.samples=1 froxel.tile=24 froxel.depth_slices=32 froxel.shadow_rays=1 march.light_resolution=32",
    "pixel.samples=1 froxel.tile=16 froxel.depth_slices=48 froxel.shadow_rays=1 march.light_resolution=32",
    "pixel.samples=1 froxel.tile=8 froxel.depth_slices=64 froxel.shadow_rays=1 march.light_resolution=64",
    "pixel.samples=4 froxel.tile=4 froxel.depth_slices=96 froxel.shadow_rays=2 march.light_resolution=96",
    "pixel.samples=16 froxel.tile=2 froxel.depth_slices=160 froxel.shadow_rays=4 march.light_resolution=128",
    "pixel.samples=32 froxel.tile=2 froxel.depth_slices=256 froxel.shadow_rays=8 march.light_resolution=192"};

constexpr std::string_view shadow_volume_rungs[] = {
    "pixel.samples=1 shadow_volume.nodes=2 shadow_volume.steps=8 shadow_volume.light_resolution=32",
    "pixel.samples=1 shadow_volume.nodes=3 shadow_volume.steps=16 shadow_volume.light_resolution=32",
    "pixel.samples=2 shadow_volume.nodes=4 shadow_volume.steps=24 shadow_volume.light_resolution=64",
    "pixel.samples=4 shadow_volume.nodes=4 shadow_volume.steps=48 shadow_volume.light_resolution=64",
    "pixel.samples=16 shadow_volume.nodes=6 shadow_volume.steps=128 shadow_volume.light_resolution=128",
    "pixel.samples=64 shadow_volume.nodes=8 shadow_volume.steps=256 shadow_volume.light_resolution=192"};

constexpr std::string_view cone_rungs[] = {"pixel.samples=1 cone.nodes=4 cone.picture=third",
                                           "pixel.samples=1 cone.nodes=4 cone.picture=half",
                                           "pixel.samples=1 cone.nodes=6",
                                           "pixel.samples=4 cone.nodes=8",
                                           "pixel.samples=16 cone.nodes=12",
                                           "pixel.samples=64 cone.nodes=16"};

constexpr std::string_view billboard_rungs[] = {"pixel.samples=1 billboard.cards=8 billboard.rays=32",
                                                "pixel.samples=1 billboard.cards=16 billboard.rays=64",
                                                "pixel.samples=1 billboard.cards=64 billboard.rays=128",
                                                "pixel.samples=4 billboard.cards=64 billboard.rays=128",
                                                "pixel.samples=16 billboard.cards=128 billboard.rays=192",
                                                "pixel.samples=64 billboard.cards=256 billboard.rays=256"};

constexpr std::string_view radial_blur_rungs[] = {"pixel.samples=1 radial_blur.samples=8 radial_blur.picture=quarter",
                                                  "pixel.samples=1 radial_blur.samples=16 radial_blur.picture=quarter",
                                                  "pixel.samples=1 radial_blur.samples=32 radial_blur.picture=half",
                                                  "pixel.samples=4 radial_blur.samples=64 radial_blur.picture=half",
                                                  "pixel.samples=16 radial_blur.samples=128 radial_blur.picture=full",
                                                  "pixel.samples=64 radial_blur.samples=256 radial_blur.picture=full"};

constexpr std::string_view path_rungs[] = {"pixel.samples=1",  "pixel.samples=4",   "pixel.samples=16",
                                           "pixel.samples=64", "pixel.samples=256", "pixel.samples=1024"};

struct Ladder {
    decltype(Mode::prepare) prepare;
    std::span<const std::string_view> rungs;
};
constexpr Ladder ladders[] = {{prepare_froxel, froxel_rungs},
                              {prepare_shadow_map, shadow_map_rungs},
                              {prepare_shadow_volume, shadow_volume_rungs},
                              {prepare_cone, cone_rungs},
                              {prepare_billboard, billboard_rungs},
                              {prepare_radial_blur, radial_blur_rungs},
                              {prepare_path, path_rungs}};

std::vector<Candidate> march_ladder(const Settings& settings) {
    std::vector<Candidate> ladder;
    for (const MarchRung& rung : march_rungs()) {
        Settings from;
        from.march = rung.march;
        Candidate candidate{rung.name, settings};
        take_rows(march_rows, from, candidate.settings);
        candidate.settings.pixel.samples = rung.samples;
        ladder.push_back(std::move(candidate));
    }
    return ladder;
}

std::span<const std::string_view> rungs_of(const Mode& mode) {
    for (const Ladder& ladder : ladders)
        if (ladder.prepare == mode.prepare) return ladder.rungs;
    return {};
}

// "name=value name=value", as words.
std::vector<std::string> assignments(std::string_view rung) {
    std::istringstream words{std::string(rung)};
    return {std::istream_iterator<std::string>(words), {}};
}
}

void take_rows(std::span<const std::string_view> names, const Settings& from, Settings& to) {
    for (const SettingRow& row : setting_rows())
        if (std::ranges::count(names, row.name)) row.set(to, row.get(from));
}

std::vector<std::string_view> ladder_rows(const Mode& mode) {
    if (mode.prepare == prepare_march) return {march_rows.begin(), march_rows.end()};
    std::vector<std::string_view> names;
    for (const std::string_view rung : rungs_of(mode))
        for (const std::string& assignment : assignments(rung)) {
            const std::string_view name = rung.substr(rung.find(assignment), assignment.find('='));
            if (name != "pixel.samples" && !std::ranges::count(names, name)) names.push_back(name);
        }
    return names;
}

std::vector<Candidate> ladder_of(const Mode& mode, const Settings& settings) {
    if (mode.prepare == prepare_march) return march_ladder(settings);
    std::vector<Candidate> ladder;
    for (const std::string_view rung : rungs_of(mode)) {
        Candidate candidate{"", settings};
        for (const std::string& assignment : assignments(rung)) {
            apply_setting(candidate.settings, assignment);
            if (assignment.starts_with("pixel.samples")) continue;
            candidate.name += (candidate.name.empty() ? "" : " ") + assignment;
        }
        ladder.push_back(std::move(candidate));
    }
    return ladder;
}
}
