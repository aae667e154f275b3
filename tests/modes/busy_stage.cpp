#include "modes/busy_stage.h"

#include "base/random.h"
#include "scene/scene.h"

namespace tyndall::test {
float wavy(vec3 p) { return 0.5f + 0.5f * std::sin(9 * p.x) * std::cos(7 * p.y + 13 * p.z); }

TestScene busy_scene() {
    std::vector<Medium> media{medium_of(unit_volume(24, wavy), 2),
                              homogeneous_medium(0.5f, {vec3(-0.3f), vec3(1.2f, 0.7f, 1.1f)})};
    media[0].optics.phase = {PhaseKind::henyey_greenstein, 0.5f}, media[0].optics.albedo = vec3(0.9f, 0.6f, 0.3f);
    media[1].optics.phase = {PhaseKind::rayleigh, 0};
    const Light spot = spot_light({0.3f, 1.5f, 0.4f}, {0.1f, -1, 0.1f}, 2, 0.3f, 0.5f);
    return make_scene(media, {sun_light({0.3f, -1, 0.1f}), spot},
                      {roof(0.35f, 1.2f), box_of(vec3(0.5f, 0.4f, 0.3f), vec3(0.7f, 0.5f, 0.6f))}, vec3(0.1f));
}

std::vector<Ray> busy_rays(int count) {
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        const Sample2 from = sample2(i, 5), to = sample2(i, 6);
        const vec3 origin(0.1f + 0.8f * from.x, 0.55f + 0.4f * from.y, 2);
        rays.push_back({origin, glm::normalize(vec3(0.1f + 0.8f * to.x, 0.55f + 0.4f * to.y, -1) - origin), 4});
    }
    return rays;
}

}
