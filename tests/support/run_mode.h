// Modes on a list of rays, and the settings that tests hold them to.
#pragma once
#include "modes/mode.h"
#include "modes/settings.h"
#include "trace/view.h"

namespace tyndall::test {
// Light along the rays, taken in packets; `per_light` gets each light's part of it.
std::vector<Scatter> scattered(const ScatterFunction& scatter, const std::vector<Ray>& rays, size_t packet = 16);
std::vector<Scatter> run_mode(std::string_view mode, const View& view, const Snapshot& snapshot,
                              const Settings& settings, const std::vector<Ray>& rays,
                              std::vector<vec3>* per_light = nullptr);

// The same of `march`, which needs no view.
std::vector<Scatter> marched(const Snapshot& snapshot, const Settings& settings, const std::vector<Ray>& rays);
Scatter marched(const Snapshot& snapshot, const Settings& settings, const Ray& ray);

// The reference, the sampled march in very short steps, and steps as short inside lit stretches.
Settings exact_settings();
Settings sampled_settings();
Settings sliced_settings();
}
