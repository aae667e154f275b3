// Fog whose extinction differs between the channels.
#include "measure/stress/authored.h"
#include "modes/froxel/limitations.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
const std::vector<Excuse> excuses{{&limitation::few_steps_for_glow, 2},
                                  {&limitation::deep_froxels, 1.2},
                                  {&limitation::deep_steps, 1.2},
                                  {&limitation::light_grid_cells},
                                  {&limitation::coarse_shafts},
                                  {&limitation::grainy_edges},
                                  shadows_ignored};
const Camera front = camera_from({0, 0, 5}, vec3(0));
const Light noon = sun_light({0.3f, -1, -0.2f}, 10);

MediumSource colored(vec3 extinction, float half = 1) {
    MediumSource source;
    source.name = "colored", source.bounds = {vec3(-half), vec3(half)};
    source.extinction = (extinction.x + extinction.y + extinction.z) / 3, source.channel_extinction = extinction;
    return source;
}
MediumSource gray(float extinction, float half) {
    MediumSource source;
    source.name = "gray", source.bounds = {vec3(-half), vec3(half)}, source.extinction = extinction;
    return source;
}

StressScene with_fog(const std::vector<MediumSource>& media, Light light, std::vector<Mesh> meshes = {}) {
    StressScene scene = stress_scene({}, {std::move(light)}, front, std::move(meshes), {lambert(vec3(0))});
    use_media(media, scene);
    return scene;
}

StressScene thick_channel(double extinction) {
    return with_fog({colored({static_cast<float>(extinction), 0.2f, 0.1f})}, noon);
}
StressScene spread(double ratio) {
    const float r = static_cast<float>(std::sqrt(ratio));
    return with_fog({colored(0.3f * vec3(1 / r, 1, r))}, noon);
}
StressScene lamp_in_it(double extinction) {
    return with_fog({colored({0.1f, 0.2f, static_cast<float>(extinction)}, 3)}, point_light({0.8f, 0.6f, 0.4f}, 10));
}
StressScene in_gray(double extinction) {
    return with_fog({gray(static_cast<float>(extinction), 2), colored({0.8f, 0.3f, 0.1f})}, noon);
}
StressScene shaft(double slit) {
    const float half = 0.5f * static_cast<float>(slit);
    return with_fog({colored({0.4f, 0.15f, 0.05f}, 3)}, sun_light({0.5f, -1, 0.1f}, 10),
                    {quad({-20, 2, -20}, {20.137f - half, 0, 0}, {0, 0, 40}, 0),
                     quad({0.137f + half, 2, -20}, {20 - half, 0, 0}, {0, 0, 40}, 0)});
}

// A white background behind it, seen head-on: the transmittance of each channel has a closed form.
StressScene before_white(double depth) {
    const float d = static_cast<float>(depth);
    StressScene scene = stress_scene({}, {}, flat_camera({0, 0, 5}, vec3(0), 1));
    use_media({colored(0.5f * vec3(d, 0.3f * d, 0.1f * d))}, scene);
    scene.snapshot.background.color = vec3(1);
    return scene;
}
double white_off(Trial& trial) {
    const Layers layers = trial.render();
    const double d = trial.value, left[] = {std::exp(-d), std::exp(-0.3 * d), std::exp(-0.1 * d)};
    double most = 0;
    for (const vec3 pixel : layers.color.pixels)
        for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(pixel[c] - left[c]));
    return most;
}
}

std::vector<StressCase> stress_colors() {
    constexpr std::string_view group = "colored extinction";
    const StressMeasure usual = default_measure();
    return {
        StressCase("thick-red", group, "one channel gets thick", "extinction", "1/m", {0.5, 2, 10, 40}, Claim::physical,
                   excuses, thick_channel, usual),
        StressCase("color-spread", group, "the channels get far apart", "ratio", "", {1, 10, 1000}, Claim::physical,
                   excuses, spread, usual),
        StressCase("colored-lamp", group, "a lamp in fog whose blue gets thick", "extinction", "1/m", {0.2, 1, 3},
                   Claim::physical, excuses, lamp_in_it, usual),
        StressCase("colored-in-gray", group, "colored fog within gray fog", "extinction", "1/m", {0.05, 0.3, 1},
                   Claim::physical, excuses, in_gray, usual),
        StressCase("colored-shaft", group, "a shaft in colored fog gets narrow", "slit", "m", {2, 0.5, 0.1},
                   Claim::physical, excuses, shaft, usual),
        StressCase("colored-transmittance", group, "each channel of the background fades by its own optical depth",
                   "optical depth of red", "", {0.1, 1, 5, 30}, Claim::noise_free, {}, before_white,
                   {1e-4, "largest error of a channel", white_off}),
    };
}
}
