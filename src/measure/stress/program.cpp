// What all modes rely on: numbers near the ends of their range, threads, crops, phase functions, noise, metrics.
#include "measure/stress/trial.h"
#include "modes/froxel/limitations.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/phase.h"

#include "base/parallel.h"
#include "base/random.h"
#include "measure/metrics/flip.h"
#include "measure/metrics/metrics.h"
#include "render/image/exr.h"
#include "scene/light.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"
#include "volume/recipe/recipe.h"

namespace tyndall {
namespace {
// Positions are rounded to as much as 4 m, the gap is 1 m wide: light may fall anywhere. Lit floors have a root mean
// square of 3.4 times the image's mean.
const std::vector<Excuse> anywhere{{&limitation::float_precision, 4}};
const std::vector<Excuse> coarse{{&limitation::coarse_shafts}, {&limitation::grainy_edges}, shadows_ignored};

// A roof with a gap over fog, the sun and a spot; moved to a place and scaled.
StressScene room_at(vec3 place, float size) {
    const auto box = [&](vec3 low, vec3 high) { return box_of(place + size * low, place + size * high, -1); };
    Light spot = spot_light(place + size * vec3(-1, 1.5f, 0), {0.3f, -1, 0}, 10 * size * size, 0.3f, 0.4f);
    spot.radius = 0.05f * size;
    const Box fog{place + size * vec3(-2), place + size * vec3(2)};
    Camera camera = camera_from(place + size * vec3(0, 0.2f, 5), place);
    camera.near *= size;
    return stress_scene(
        {homogeneous_medium(0.2f / size, fog, forward_phase(0.3f))}, {sun_light({0.5f, -1, 0.1f}, 10), spot}, camera,
        {box({-9, 2, -9}, {-0.5f, 2.1f, 9}), box({0.5f, 2, -9}, {9, 2.1f, 9}), box({-9, -2.1f, -9}, {9, -2, 9})});
}
StressScene room(double) { return room_at(vec3(0), 1); }

StressScene away(double offset) { return room_at(vec3(static_cast<float>(offset)), 1); }
StressScene sized(double size) { return room_at(vec3(0), static_cast<float>(size)); }
double off_from_usual(Trial& trial) { return difference(trial.render(), trial.render(room(0))); }

double different_pixels(const Layers& a, const Layers& b) {
    double count = 0;
    for (size_t i = 0; i < a.color.pixels.size(); ++i)
        count += a.color.pixels[i] != b.color.pixels[i] || a.inscatter.pixels[i] != b.inscatter.pixels[i] ||
                 a.transmittance.pixels[i] != b.transmittance.pixels[i];
    return count;
}

double threads_off(Trial& trial) {
    const int before = thread_count();
    const Layers usual = trial.render();
    set_thread_count(static_cast<int>(trial.value));
    const Layers other = trial.render();
    set_thread_count(before);
    return different_pixels(usual, other);
}

double crop_off(Trial& trial) {
    StressScene part = trial.scene;
    part.view.crop_low = ivec2(static_cast<int>(trial.value)), part.view.crop_high = part.view.crop_low + ivec2(11, 9);
    Layers whole = trial.render();
    const Layers crop = trial.render(part);
    double count = 0;
    for (int y = 0; y < crop.size.y; ++y)
        for (int x = 0; x < crop.size.x; ++x) {
            const ivec2 at = crop.low + ivec2(x, y);
            count += crop.color.at(x, y) != whole.color.at(at.x, at.y) ||
                     crop.inscatter.at(x, y) != whole.inscatter.at(at.x, at.y);
        }
    return count;
}

StressScene dark(double) {
    StressScene scene = room_at(vec3(0), 1);
    scene.snapshot.lights.clear();
    return scene;
}
double not_black(Trial& trial) {
    const Layers layers = trial.render();
    return std::max(max_of(layers.color), max_of(layers.inscatter));
}

StressScene flat_view(double fov) {
    StressScene scene = room_at(vec3(0), 1);
    scene.view.camera.vertical_fov = static_cast<float>(fov);
    return scene;
}

StressScene odd_size(double pixels) {
    StressScene scene = room_at(vec3(0), 1);
    scene.view.size = {static_cast<int>(pixels), std::max(1, static_cast<int>(pixels) / 3)};
    return scene;
}

// --- the program's own parts -----------------------------------------------------------------------------------------
double phase_integral(Phase phase) {
    // Integrates over u with cosine = 1 - 2 u^4 about the lobe, which resolves narrow lobes.
    const double sign = phase.g < 0 ? -1 : 1;
    return integral(
        [&](double u) {
            const double cosine = 1 - 2 * u * u * u * u;
            return 2 * std::numbers::pi * 8 * u * u * u * phase_value(phase, static_cast<float>(sign * cosine));
        },
        0, 1, 400);
}
double phase_off(Trial& trial) {
    return std::abs(phase_integral({PhaseKind::henyey_greenstein, static_cast<float>(trial.value)}) - 1);
}
double schlick_off(Trial& trial) {
    const Phase phase{PhaseKind::schlick, static_cast<float>(trial.value)};
    double least = 1;
    for (int i = 0; i <= 200; ++i) least = std::min<double>(least, phase_value(phase, 0.01f * float(i) - 1));
    return least < 0 ? infinity : std::abs(phase_integral(phase) - 1);
}

// Error of the mean cosine of sampled directions.
double sampling_off(Trial& trial) {
    constexpr int count = 1 << 16;
    const Phase phase{PhaseKind::henyey_greenstein, static_cast<float>(trial.value)};
    double sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const Sample2 u = sample2(i, 9);
        sum += glm::dot(sample_phase(phase, vec3(0, 0, 1), {u.x, u.y}), vec3(0, 0, 1));
    }
    return std::abs(sum / count - std::min<double>(trial.value, largest_g));
}

// Number of points of a rough grid that are denser than the majorant or the maximum of their brick.
double majorant_off(Trial& trial) {
    const auto seed = static_cast<uint32_t>(trial.value);
    const Medium fog = grid_medium(1, 24, [seed](vec3 p) {
        const glm::uvec3 cell(p * 24.0f);
        const float value = to_unit(hash(cell.x, cell.y, cell.z, seed));
        return value > 0.97f ? 60000 * value : value;
    });
    double count = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
        const vec3 p(random_unit(i, 0, 0, seed), random_unit(i, 0, 1, seed), random_unit(i, 0, 2, seed));
        const vec3 local = local_point(*fog.density.bricks, p);
        const ivec3 brick = glm::clamp(ivec3(local / 8.0f), ivec3(0), fog.density.bricks->size - 1);
        const ivec3 size = fog.density.bricks->size;
        const float bound = fog.density.bricks->maximum[size_t((brick.x * size.y + brick.y) * size.z + brick.z)];
        const float density = density_at(fog, p);
        count += density > fog.majorant() * 1.000001f || density > bound * 1.000001f;
    }
    return count;
}

FogRecipe drifting(double period) {
    FogRecipe recipe;
    recipe.noise.scale = 0.4f, recipe.noise.evolve = 0.3f, recipe.noise.seed = 3;
    recipe.threshold = 0.45f, recipe.period = period, recipe.wind = vec3(0.2f, 0.05f, 0), recipe.swirl = 0.1f;
    recipe.swirl_speed = 0.2f;
    return recipe;
}

struct Points {
    std::vector<float> x, y, z, density;
    explicit Points(size_t count, float spread = 1) : x(count), y(count), z(count), density(count) {
        for (uint32_t i = 0; i < count; ++i) {
            x[i] = spread * (2 * random_unit(i, 0, 0, 4) - 1), y[i] = spread * (2 * random_unit(i, 0, 1, 4) - 1);
            z[i] = spread * (2 * random_unit(i, 0, 2, 4) - 1);
        }
    }
};

double loop_off(Trial& trial) {
    Points first(2048), last(2048);
    recipe_density(drifting(trial.value), 0, first.x, first.y, first.z, first.density);
    recipe_density(drifting(trial.value), trial.value, last.x, last.y, last.z, last.density);
    double most = 0;
    for (size_t i = 0; i < first.density.size(); ++i)
        most = std::max<double>(most, std::abs(first.density[i] - last.density[i]));
    return most;
}

// Relative change of the noise's root mean square far from the origin.
double noise_off(Trial& trial) {
    const auto spread = [](float away) {
        Points points(4096, 8);
        for (float& x : points.x) x += away;
        FractalNoise noise;
        fractal_noise(noise, 0, points.x, points.y, points.z, points.density);
        double squares = 0;
        for (const float value : points.density) squares += double(value) * value;
        return std::sqrt(squares / 4096);
    };
    return std::abs(spread(static_cast<float>(trial.value)) / spread(0) - 1);
}

// Voxels that hold fog by the recipe but are missing in the grown grid.
double culling_off(Trial& trial) {
    FogRecipe recipe = drifting(0);
    recipe.threshold = static_cast<float>(trial.value), recipe.voxel_size = 1.0 / 24;
    const Medium grown = [&] {
        Medium medium;
        medium.density.kind = DensityKind::bricks, medium.density.bricks = make_bricks(generate(recipe, 0.3));
        return medium;
    }();
    std::vector<float> x, y, z;
    for (int i = 0; i < 48; ++i)
        for (int j = 0; j < 48; ++j)
            for (int k = 0; k < 48; ++k) {
                const vec3 p = recipe.bounds.low + (vec3(i, j, k) + 0.5f) / 24.0f;
                x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
            }
    std::vector<float> density(x.size());
    recipe_density(recipe, 0.3, x, y, z, density);
    double missing = 0;
    for (size_t i = 0; i < x.size(); ++i)
        missing +=
            density[i] > 0.01f && !(sample_density(*grown.density.bricks, {x[i], y[i], z[i]}) > 0.5f * density[i]);
    return missing;
}

// Every metric of an image against itself must be finite and 0.
double metrics_off(Trial& trial) {
    const Image<vec3> picture(ivec2(16, 16), vec3(static_cast<float>(trial.value)));
    const Errors errors = measure_errors(picture, picture);
    const FlipExposures exposures = flip_exposures(picture);
    double sum = relative(errors.rmse, errors.mean_reference) + errors.rel_mse + errors.bias;
    for (const float value : flip_hdr(picture, picture, exposures, flip_pixels_per_degree).pixels) sum += value;
    return std::abs(sum);
}

// Relative error of stored values, clamped to the range of half floats.
double stored_off(Trial& trial) {
    Layers layers;
    layers.display = layers.size = {8, 8};
    const float value = static_cast<float>(trial.value);
    layers.color = Image<vec3>(layers.size, vec3(value, 0.7f * value, -value));
    double most = 0;
    for (const bool full : {false, true}) {
        const vec3 stored = stored_color(layers, {.layers = {}, .full_float = full}).pixels[5];
        if (!is_finite(stored)) return infinity;
        const float reached = full ? value : std::min(value, 65504.0f);
        most = std::max<double>(most, std::abs(stored.x / reached - 1));
    }
    return most;
}
}

std::vector<StressCase> stress_program() {
    constexpr std::string_view group = "numbers", own = "program";
    return {
        StressCase("far-from-origin", group, "a scene far from the origin", "distance", "m", {10, 1e3, 1e4, 1e5, 1e6},
                   Claim::noise_free, anywhere, away,
                   {0.05, "relative RMSE against the same at the origin", off_from_usual}),
        StressCase("units", group, "everything larger or smaller", "size", "times", {2, 0.3, 1e-3, 1e3, 1e5},
                   Claim::noise_free, {}, sized, {0.03, "relative RMSE against the usual size", off_from_usual}),
        StressCase("threads", group, "the same bits on any number of threads", "threads", "", {1, 3}, Claim::all, {},
                   room, {0, "pixels that differ", threads_off}),
        StressCase("crops", group, "a crop has the same bits as the whole image", "corner", "pixels", {0, 5, 13},
                   Claim::all, {}, room, {0, "pixels that differ", crop_off}),
        StressCase("no-light", group, "without a light the image is black", "lights", "", {0}, Claim::all, {}, dark,
                   {0, "brightest pixel", not_black}),
        StressCase("field-of-view", group, "from a very narrow view to a fisheye", "field of view", "radians",
                   {0.7, 0.05, 1e-3, 2.5, 3.1}, Claim::noise_free, coarse, flat_view),
        StressCase("picture-size", group, "images of few pixels", "width", "pixels", {50, 17, 4, 1}, Claim::noise_free,
                   coarse, odd_size),
        StressCase("phase-sum", own, "the phase function integrates to 1", "g", "", {0, 0.5, -0.5, 0.9, 0.99, -0.99},
                   {}, {}, nullptr, {1e-3, "integral over the sphere minus 1", phase_off}),
        StressCase("schlick-sum", own, "the same for Schlick's form", "g", "", {0, 0.3, 0.5, -0.5}, {}, {}, nullptr,
                   {1e-3, "integral over the sphere minus 1", schlick_off}),
        StressCase("phase-samples", own, "sampled directions follow the phase function", "g", "",
                   {0, 1e-4, -1e-3, 0.5, 0.99}, {}, {}, nullptr, {1e-3, "error of the mean cosine", sampling_off}),
        StressCase("majorants", own, "no density exceeds its majorant", "seed", "", {1, 2, 3}, {}, {}, nullptr,
                   {0, "points above it", majorant_off}),
        StressCase("noise-loop", own, "noise that repeats has no seam", "period", "s", {1, 4, 7.3, 100}, {}, {},
                   nullptr, {1e-5, "largest difference between start and end", loop_off}),
        StressCase("noise-far-away", own, "noise far from the origin", "distance", "cells", {1e2, 1e4, 1e5, 2e6}, {},
                   {}, nullptr, {0.1, "change of its spread", noise_off}),
        StressCase("culling", own, "no leaf with fog is skipped", "threshold", "", {0.3, 0.5, 0.6, 0.7}, {}, {},
                   nullptr, {0, "voxels missing", culling_off}),
        StressCase("black-metrics", own, "metrics of black images are numbers", "value", "", {1, 1e-30, 0}, {}, {},
                   nullptr, {0, "sum of all metrics", metrics_off}),
        StressCase("stored-range", own, "bright pixels in files stay finite", "value", "", {1e-3, 1, 6e4, 1e6, 1e30},
                   "", {}, nullptr, {1e-3, "relative error of what is stored", stored_off}),
    };
}
}
