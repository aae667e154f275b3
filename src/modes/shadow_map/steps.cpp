// Where steps lie: exactly between entry and exit of fog and light.
#include "modes/shadow_map/kernel.h"
#include "scene/light.h"
#include "volume/medium.h"
#include "volume/rays/fog_reach.h"

namespace tyndall {
void place_steps(const ShadowMapMarch& march, const Ray& ray, int count, float* t, size_t stride) {
    const Interval stretch = fog_stretch(march.snapshot.media, ray);
    const auto even = [&](Interval part, int first, int steps) {
        const float step = part.length() / static_cast<float>(std::max(steps, 1));
        for (int k = 0; k <= steps; ++k)
            t[static_cast<size_t>(first + k) * stride] = part.low + step * static_cast<float>(k);
    };
    const Interval scene = clip(march.snapshot.bounds, ray.origin, ray.direction, stretch);
    if (scene.empty() || stretch.length() < 2 * scene.length() || count < least_uneven_steps)
        return even(stretch, 0, count);

    const int before = scene.low > stretch.low ? count / 8 : 0, after = stretch.high > scene.high ? count / 4 : 0;
    even({stretch.low, scene.low}, 0, before);
    even(scene, before, count - before - after);
    const float start = 0.25f * scene.length(), growth = (stretch.high - scene.high) / start;
    for (int k = 1; k <= after; ++k)
        t[static_cast<size_t>(count - after + k) * stride] =
            scene.high + start * (std::pow(1 + growth, static_cast<float>(k) / static_cast<float>(after)) - 1);
}

Interval lit_interval(const Light& light, const Ray& ray, Interval stretch) {
    const Stretch reach = light_reach(light, dvec3(ray.origin), dvec3(ray.direction));
    stretch.low = std::max(stretch.low, static_cast<float>(reach.low));
    stretch.high = std::min(stretch.high, static_cast<float>(reach.high));
    return reach.empty() || stretch.empty() ? Interval{} : stretch;
}
}
