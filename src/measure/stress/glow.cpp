// Emissive surfaces, whose light fog scatters.
#include "measure/stress/authored.h"
#include "modes/area_light_limitations.h"
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
const std::vector<Excuse> excuses{{&limitation::emission_lights_no_fog},
                                  {&limitation::lamps_for_surfaces},
                                  {&limitation::few_steps_for_glow, 2},
                                  {&limitation::coarse_shafts},
                                  {&limitation::grainy_edges, 1.5},
                                  {&limitation::hard_shadows, 0.5},
                                  shadows_ignored};
const Camera beside = camera_from({0.5f, 0.4f, 3.5f}, vec3(0));

// The first material glows, the second is black.
StressScene glowing(std::vector<Mesh> meshes, Camera camera = beside, Medium haze = thin_haze()) {
    return authored({std::move(haze)}, {}, camera, std::move(meshes),
                    {lambert(vec3(0), vec3(5, 3, 1)), lambert(vec3(0))});
}

Mesh plate(float width, float height) {
    return quad({-0.5f * width, -0.5f * height, 0}, {width, 0, 0}, {0, height, 0}, 0);
}

StressScene of_side(double side) { return glowing({plate(static_cast<float>(side), static_cast<float>(side))}); }

// Its area stays the same.
StressScene of_length(double length) {
    return glowing({plate(static_cast<float>(length), 0.04f / static_cast<float>(length))});
}

StressScene closed_box(double side) {
    const vec3 half(0.5f * static_cast<float>(side));
    return glowing({box_of(-half, half, 0)});
}

StressScene in_fog(double extinction) {
    return glowing({plate(0.5f, 0.5f)}, beside, thin_haze(static_cast<float>(extinction)));
}

// Bars in front that hide half of it.
StressScene behind_grille(double bar) {
    std::vector<Mesh> meshes{plate(1, 1)};
    const float width = static_cast<float>(bar);
    for (float x = -1; x < 1; x += 2 * width) meshes.push_back(box_of({x, -1, 0.4f}, {x + width, 1, 0.42f}, 1));
    return glowing(std::move(meshes));
}

// The glowing plate with an alpha and a texture.
StressScene with_alpha(AlphaMode mode, float alpha, Texture texture) {
    StressScene scene = glowing({plate(1, 1)});
    Material& material = scene.scene->materials[0];
    material.alpha_mode = mode, material.alpha = alpha, material.base_texture = 0;
    scene.scene->textures = {std::move(texture)};
    add_surfaces(*scene.scene, scene.snapshot);
    return scene;
}

StressScene clear(double alpha) {
    Texture texture;
    texture.texels = shared_texels(Image<vec4>(ivec2(1), vec4(1)));
    return with_alpha(AlphaMode::blend, static_cast<float>(alpha), std::move(texture));
}

// Stripes of which a share is left.
StressScene cut_out(double share) {
    Image<vec4> stripes(ivec2(80, 1), vec4(1));
    for (int x = 0; x < 80; ++x) stripes.at(x, 0).w = x % 20 < static_cast<int>(20 * share) ? 1.0f : 0.0f;
    Texture texture;
    texture.nearest = true, texture.texels = shared_texels(std::move(stripes));
    return with_alpha(AlphaMode::mask, 1, std::move(texture));
}

StressScene eye_before(double distance) {
    return glowing({plate(1, 1)}, camera_from({0.1f, 0.1f, static_cast<float>(distance)}, {1.5f, 0.3f, 1.5f}));
}
}

std::vector<StressCase> stress_glow() {
    constexpr std::string_view group = "glowing surfaces";
    const StressMeasure usual = default_measure();
    return {
        StressCase("small-glow", group, "a glowing plate shrinks below a pixel", "side", "m", {1, 0.2, 0.02},
                   Claim::physical, excuses, of_side, usual),
        StressCase("long-glow", group, "it gets long and thin", "length", "m", {0.2, 1, 5}, Claim::physical, excuses,
                   of_length, usual),
        StressCase("closed-glow", group, "a box that glows all around", "side", "m", {0.1, 0.5, 1.5}, Claim::physical,
                   excuses, closed_box, usual),
        StressCase("glow-in-fog", group, "the fog around it gets thick", "extinction", "1/m", {0.02, 0.2, 2},
                   Claim::physical, excuses, in_fog, usual),
        StressCase("grille", group, "it shines through bars that get fine", "bar", "m", {0.4, 0.1, 0.03},
                   Claim::physical, excuses, behind_grille, usual),
        StressCase("clear-glow", group, "a glowing pane gets clear", "alpha", "", {1, 0.5, 0.1}, Claim::physical,
                   excuses, clear, usual),
        StressCase("cut-out-glow", group, "little is left of glowing stripes", "share left", "", {0.8, 0.4, 0.1},
                   Claim::physical, excuses, cut_out, usual),
        StressCase("eye-at-glow", group, "the camera comes near it", "distance", "m", {2, 0.5, 0.02}, Claim::physical,
                   excuses, eye_before, usual),
    };
}
}
