// Profiles and gobos at their worst: sharp edges, dark poles, fine stripes, posts in the beam.
#include "base/image.h"
#include "measure/stress/authored.h"
#include "modes/froxel/limitations.h"
#include "modes/light_filters.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/lights/gobo.h"
#include "scene/mesh.h"
#include "scene/photometry/ies_file.h"
#include "scene/photometry/ies_profile.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
// A pixel's few samples of a beam miss finer detail.
const std::vector<Excuse> excuses{{&limitation::sampled_gobo, 0.5},
                                  {&limitation::blurred_filter, 0.5},
                                  {&limitation::few_steps_for_glow, 2},
                                  {&limitation::deep_froxels},
                                  {&limitation::deep_steps},
                                  {&limitation::coarse_shafts},
                                  {&limitation::grainy_edges},
                                  shadows_ignored};
const Camera beside = camera_from({0, 0.5f, 5}, {0, 0.5f, 0});

// An IES profile of candela over the angle from the light's axis, 0 to 90 degrees.
std::shared_ptr<const IesProfile> profile(std::string name, const std::function<double(double degrees)>& candela) {
    IesFile file;
    file.horizontal = {0};
    for (int i = 0; i <= 900; ++i) file.vertical.push_back(0.1 * i), file.candela.push_back(candela(0.1 * i));
    return make_ies_profile(file, std::move(name));
}

// A lamp as in a scene file.
StressScene lit_by(std::shared_ptr<const IesProfile> profile) {
    Scene scene;
    LightSource& lamp = scene.lights.emplace_back();
    lamp.name = "lamp", lamp.intensity = 10.0f, lamp.profile = std::move(profile);
    lamp.position = vec3(0, 2, 0), lamp.direction = vec3(0.3f, -1, 0.1f);
    return stress_scene({thin_haze(0.2f)}, make_snapshot(scene, Moment{0, 0}).lights, beside);
}

// Constant up to 25 degrees, then falling to 0 within `width` degrees.
StressScene cut_off(double width) {
    return lit_by(profile("edge " + std::to_string(width),
                          [&](double at) { return std::clamp((25 + width - at) / width, 0.0, 1.0); }));
}

// A ring of light around a dark pole.
StressScene dark_pole(double width) {
    return lit_by(profile("ring " + std::to_string(width),
                          [&](double at) { return std::max(0.0, 1 - std::abs(at - 30) / width); }));
}

Light striped(int stripes) {
    Image<vec3> image(ivec2(8 * stripes, 8), vec3(0));
    for (int x = 0; x < image.size.x; ++x)
        for (int y = 0; y < 8; ++y) image.at(x, y) = vec3(x / 4 % 2 == 0 ? 1 : 0);
    const Light spot = spot_light({-0.8f, 2, 0}, {0.4f, -1, 0.1f}, 20, 0.35f, 0.4f);
    return filtered_light(spot, nullptr, make_gobo(image));
}
StressScene stripes(double count) {
    return stress_scene({thin_haze(0.2f)}, {striped(static_cast<int>(count))}, beside);
}
StressScene stripes_in_fog(double extinction) {
    return stress_scene({thin_haze(static_cast<float>(extinction))}, {striped(3)}, beside);
}

StressScene past_a_post(double width) {
    const float half = 0.5f * static_cast<float>(width);
    return stress_scene({thin_haze(0.2f)}, {striped(2)}, beside,
                        {box_of({-0.4f - half, 0, -3}, {-0.4f + half, 0.1f, 3}, 0)}, {lambert(vec3(0))});
}
}

std::vector<StressCase> stress_beams() {
    constexpr std::string_view group = "profiles and gobos";
    const StressMeasure usual = default_measure();
    return {
        StressCase("cut-off", group, "the edge of an IES profile gets sharp", "edge", "degrees", {20, 5, 0.5},
                   Claim::physical, excuses, cut_off, usual),
        StressCase("dark-pole", group, "a profile that is dark along its axis: its ring gets thin", "ring", "degrees",
                   {25, 8, 2}, Claim::physical, excuses, dark_pole, usual),
        StressCase("stripes", group, "the stripes of a gobo get fine", "stripes", "", {2, 8, 32}, Claim::physical,
                   excuses, stripes, usual),
        StressCase("gobo-in-fog", group, "a gobo in fog that gets thick", "extinction", "1/m", {0.05, 0.5, 2},
                   Claim::physical, excuses, stripes_in_fog, usual),
        StressCase("gobo-past-post", group, "a gobo and a post that gets thin", "post", "m", {0.6, 0.2, 0.04},
                   Claim::physical, excuses, past_a_post, usual),
    };
}
}
