#include "render/ladders.h"

#include "modes/techniques.h"

#include <cassert>
#include <span>
#include <sstream>

namespace tyndall {
namespace {
// Rays per pixel grow with care, so that the edges of surfaces do not hide what the fog gains.
constexpr int march_samples[] = {1, 1, 4, 16, 32, 64, 64};

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
    "pixel.samples=32 froxel.tile=1 froxel.depth_slices=320 froxel.shadow_rays=8 march.light_resolution=192"};

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

std::vector<Candidate> march_ladder(const Mode& mode, const Settings& settings) {
    Settings usual = settings;
    usual.march = settings_for(Quality::preview).march;
    std::vector<Candidate> ladder = candidates_of(mode, usual, Quality::preview);
    assert(ladder.size() == std::size(march_samples));
    for (size_t i = 0; i < ladder.size(); ++i) ladder[i].settings.pixel.samples = march_samples[i];
    return ladder;
}

Candidate rung_of(std::string_view rows, const Settings& settings) {
    Candidate rung{std::string(rows), settings};
    std::istringstream words{rung.name};
    for (std::string word; words >> word;) apply_setting(rung.settings, word);
    return rung;
}
}

std::vector<Candidate> ladder_of(const Mode& mode, const Settings& settings) {
    if (has_integrator(mode)) return march_ladder(mode, settings);
    std::vector<Candidate> ladder;
    for (const Ladder& known : ladders)
        if (known.prepare == mode.prepare)
            for (const std::string_view rows : known.rungs) ladder.push_back(rung_of(rows, settings));
    assert(!ladder.empty());
    return ladder;
}
}
