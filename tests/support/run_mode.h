// Modes on a list of rays, how their answers compare, and the settings that tests hold them to.
#pragma once
#include "modes/mode.h"
#include "modes/settings.h"
#include "trace/view.h"

namespace tyndall::test {
View view_of(vec3 eye, vec3 target, ivec2 size = {64, 36}, float vertical_fov = 0.8f);

// One ray through the center of every pixel, up to the first surface or `far`.
std::vector<Ray> pixel_rays(const View& view, const Snapshot& snapshot, float far = 1000);

// Of luminance: the mean, the root mean square of the differences, and that by the mean of the truth.
double mean_of(const std::vector<Scatter>& results);
double rms_difference(const std::vector<Scatter>& a, const std::vector<Scatter>& b);
double relative_rmse(const std::vector<Scatter>& results, const std::vector<Scatter>& truth);

// Light along the rays, taken in packets; `of_parts` gets the parts of it.
std::vector<Scatter> scattered(const ScatterFunction& scatter, const std::vector<Ray>& rays, size_t packet = 16);
std::vector<Scatter> run_mode(std::string_view mode, const View& view, const Snapshot& snapshot,
                              const Settings& settings, const std::vector<Ray>& rays,
                              std::vector<vec3>* of_parts = nullptr);

// The same of `march`, which needs no view.
std::vector<Scatter> marched(const Snapshot& snapshot, const Settings& settings, const std::vector<Ray>& rays);
Scatter marched(const Snapshot& snapshot, const Settings& settings, const Ray& ray);

// The reference, the sampled march in very short steps, and steps as short inside lit stretches.
Settings exact_settings();
Settings sampled_settings();
Settings sliced_settings();
}
