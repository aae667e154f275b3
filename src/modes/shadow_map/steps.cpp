// Step boundaries, exactly between entry and exit of the fog.
#include "integrate/march_steps.h"
#include "modes/shadow_map/kernel.h"
#include "volume/medium.h"
#include "volume/rays/fog_reach.h"

namespace tyndall {
void place_steps(const ShadowMapMarch& march, const Ray& ray, int count, float* t, size_t stride) {
    const Interval<float> stretch = fog_interval(march.snapshot.media, ray);
    const auto even = [&](Interval<float> part, int first, int steps) {
        const float step = part.length() / static_cast<float>(std::max(steps, 1));
        for (int k = 0; k <= steps; ++k)
            t[static_cast<size_t>(first + k) * stride] = part.low + step * static_cast<float>(k);
    };
    const Interval<float> scene = scene_part(march.snapshot, ray, stretch);
    if (scene.length() == stretch.length() || count < min_uneven_steps) return even(stretch, 0, count);

    const int before = scene.low > stretch.low ? count / 8 : 0, after = stretch.high > scene.high ? count / 4 : 0;
    even({stretch.low, scene.low}, 0, before);
    even(scene, before, count - before - after);
    const float start = 0.25f * scene.length(), growth = (stretch.high - scene.high) / start;
    for (int k = 1; k <= after; ++k)
        t[static_cast<size_t>(count - after + k) * stride] =
            scene.high + start * (std::pow(1 + growth, static_cast<float>(k) / static_cast<float>(after)) - 1);
}
}
