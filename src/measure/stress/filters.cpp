// Lights with filters: IES profiles that get narrow, gobos that get fine.
#include "measure/stress/trial.h"
#include "modes/froxel/limitations.h"
#include "modes/light_filters.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/lights/gobo.h"
#include "scene/photometry/ies_profile.h"

namespace tyndall {
namespace {
// A pixel's few samples of a beam miss finer squares.
const std::vector<Excuse> edges{{&limitation::sampled_gobo, 0.5},
                                {&limitation::blurred_filter, 0.5},
                                {&limitation::few_steps_for_glow, 2},
                                {&limitation::deep_froxels}};

Medium haze() { return homogeneous_medium(0.2f, {vec3(-6), vec3(6)}); }
const Camera beside = camera_from({0, 0.5f, 5}, {0, 0.5f, 0});

StressScene narrow_profile(double power) {
    Light light = point_light({0, 2, 0}, 10);
    light.direction = glm::normalize(vec3(0.4f, -1, 0.1f));
    return stress_scene({haze()}, {filtered_light(light, lobe_profile(power), nullptr)}, beside);
}

StressScene board(int squares, vec3 color) {
    const Light spot = spot_light({-0.8f, 2, 0}, {0.4f, -1, 0.1f}, 20, 0.35f, 0.4f);
    return stress_scene({haze()}, {filtered_light(spot, nullptr, board_gobo(squares, 4, color, vec3(0.05f)))}, beside);
}
StressScene gray_board(double squares) { return board(static_cast<int>(squares), vec3(1)); }
StressScene colored_board(double squares) { return board(static_cast<int>(squares), {1, 0.4f, 0.1f}); }
}

std::vector<StressCase> stress_filters() {
    constexpr std::string_view group = "profiles and gobos";
    return {
        StressCase("narrow-profile", group, "an IES profile gets narrow", "power of the cosine", "", {1, 8, 64, 512},
                   Claim::physical, edges, narrow_profile),
        StressCase("gobo", group, "the squares of a gobo get small", "squares across", "", {2, 4, 8, 16},
                   Claim::physical, edges, gray_board),
        StressCase("colored-gobo", group, "the same in colors", "squares across", "", {2, 8}, Claim::physical, edges,
                   colored_board),
    };
}
}
