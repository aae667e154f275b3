// Fog from grids: odd transforms and sizes, sheets and single voxels, detail that gets fine or thick.
#include "measure/stress/volumes.h"
#include "modes/froxel/limitations.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall {
namespace {
// A step or cell takes one sample of a density whose standard deviation is 0.95 of its mean (`roughness`), less where
// it is smoothed. The light of wisps has a root mean square of 2.7 times its mean: spread evenly, its relative error is
// sqrt(2.7 * 2.7 - 1) = 2.5.
constexpr Excuse noise{&limitation::long_steps, 0.9}, homogeneous{&limitation::drawn_as_homogeneous, 2.5};
const std::vector<Excuse> detail{noise,
                                 homogeneous,
                                 {&limitation::light_grid_cells, 0.9},
                                 {&limitation::deep_steps, 0.9},
                                 {&limitation::deep_froxels, 0.9}};
const std::vector<Excuse> shafts{noise,
                                 {&limitation::light_grid_cells},
                                 {&limitation::deep_steps},
                                 {&limitation::deep_froxels},
                                 {&limitation::coarse_shafts},
                                 {&limitation::grainy_edges, noise.up_to}};

// The transform of a round cloud: scaled by (1, 2, 5) and sheared; mirrored for negative values.
dmat4 skew(double shear) {
    dmat4 matrix(1);
    matrix[1] = glm::dvec4(std::abs(shear), 2, 0, 0), matrix[2] = glm::dvec4(0, 0.5 * shear, 5, 0);
    if (shear < 0) matrix[0].x = -1;
    return matrix;
}
StressScene skewed(double shear) {
    SparseVolume volume = unit_volume(48, [](vec3 p) { return blob(p); });
    volume.index_to_world = skew(shear) * volume.index_to_world;
    const vec3 center(skew(shear) * glm::dvec4(0.5, 0.5, 0.5, 1));
    return stress_scene({medium_of(volume, 1)}, {noon_light}, camera_from(center + vec3(1, 2, 9), center, 0.35f));
}

// In object space the density is exp(-24 r^2): a ray that passes the center at distance h has the optical depth
// sqrt(pi / 24) exp(-24 h^2) / length, where length is that of the ray's unit direction in object space.
double depth_off(Trial& trial) {
    const Layers layers = trial.render();
    const dmat4 own = glm::inverse(skew(trial.value));
    double squares = 0, sum = 0;
    for (int y = 0; y < layers.size.y; ++y)
        for (int x = 0; x < layers.size.x; ++x) {
            const Ray ray = camera_ray(trial.scene.view.camera, layers.size, vec2(x, y) + 0.5f);
            const dvec3 from = dvec3(own * glm::dvec4(ray.origin, 1)) - 0.5;
            const dvec3 along(own * glm::dvec4(ray.direction, 0));
            const double length = glm::length(along), t = -glm::dot(from, along) / (length * length);
            const dvec3 nearest = from + t * along;
            const double depth = std::sqrt(std::numbers::pi / 24) * std::exp(-24 * glm::dot(nearest, nearest)) / length;
            const double off = layers.transmittance.at(x, y) - std::exp(-depth);
            squares += off * off, sum += -std::expm1(-depth);
        }
    const double pixels = static_cast<double>(layers.size.x) * layers.size.y;
    return std::sqrt(squares / pixels) / (sum / pixels);
}

StressScene sized(float s) {
    Camera camera = camera_from(s * vec3(0.6f, 0.7f, 2.6f), vec3(0.5f * s));
    camera.near *= s;
    SparseVolume volume = unit_volume(16, roughness);
    volume.index_to_world = glm::scale(dmat4(1), dvec3(s)) * volume.index_to_world;
    return stress_scene({medium_of(volume, 3 / s)}, {noon_light}, camera);
}
StressScene of_size(double size) { return sized(static_cast<float>(size)); }
double size_off(Trial& trial) { return difference(trial.render(), trial.render(sized(1))); }

// Height of an image that shows a block and the voxel around it in which it fades.
float block_height(ivec3 size) { return static_cast<float>(std::max(size.x, size.y) + 2) / 16; }

// A block of voxels in the middle of a grid, and nothing else.
StressScene block(ivec3 size) {
    SparseVolume volume = unit_volume(16, [](vec3) { return 0.0f; });
    for (Leaf& leaf : volume.leaves)
        for (int i = 0; i < 512; ++i) {
            const ivec3 voxel = leaf.origin + ivec3(i / 64, i / 8 % 8, i % 8) - 5;
            const bool in = glm::all(glm::greaterThanEqual(voxel, ivec3(0))) && glm::all(glm::lessThan(voxel, size));
            leaf.values[static_cast<size_t>(i)] = in ? 1.0f : 0.0f;
        }
    volume.active_low = ivec3(5), volume.active_high = 4 + size;
    const vec3 center = (vec3(5) + 0.5f * vec3(size)) / 16.0f;
    return stress_scene({medium_of(volume, 8)}, {noon_light},
                        flat_camera(center + vec3(0, 0, 3), center, block_height(size)));
}
// Pixels, and steps of constant length, divide its voxels evenly.
StressScene small_block(double side) { return block(ivec3(static_cast<int>(side))); }
StressScene flat_block(double layers) { return block({6, 6, static_cast<int>(layers)}); }

// Optical depth integrated over the image: each voxel counts by its volume.
double mass_off(Trial& trial) {
    const Layers layers = trial.render();
    const double side = trial.value / 16, pixel = (side + 2.0 / 16) / layers.size.y;
    double sum = 0;
    for (const float share : layers.transmittance.pixels) sum -= std::log(std::max(share, 1e-30f)) * pixel * pixel;
    return std::abs(sum / (8 * side * side * side) - 1);
}

// Density grows along x, across the faces of all leaves. Only the middle half of the grid is rendered, so that no ray
// meets the fading voxels at its border.
constexpr float ramp_depth = 0.5f;
StressScene ramp(double voxels) {
    Medium fog = medium_of(unit_volume(static_cast<int>(voxels), [](vec3 p) { return p.x; }), 2);
    fog.world_bounds.low.z = 0.5f - 0.5f * ramp_depth, fog.world_bounds.high.z = 0.5f + 0.5f * ramp_depth;
    fog.density.bounds = fog.world_bounds;
    return stress_scene({fog}, {noon_light}, flat_camera({0.5f, 0.5f, 3}, vec3(0.5f), 0.4f));
}
double ramp_off(Trial& trial) {
    const Layers layers = trial.render();
    double most = 0;
    for (int x = 0; x < layers.size.x; ++x) {
        const float at = 0.5f + ((static_cast<float>(x) + 0.5f) / static_cast<float>(layers.size.x) - 0.5f) * 0.4f *
                                    static_cast<float>(layers.size.x) / static_cast<float>(layers.size.y);
        most = std::max(most, std::abs(layers.transmittance.at(x, 13) - std::exp(-2.0 * ramp_depth * at)));
    }
    return most;
}

StressScene wisps(double voxels) {
    const SparseVolume volume = unit_volume(static_cast<int>(voxels), [](vec3 p) {
        const float a = p.x + 0.35f * std::sin(7 * p.y) + 0.2f * std::cos(9 * p.z) - 0.5f;
        return std::exp(-2000 * a * a);
    });
    return looking_at(medium_of(volume, 8));
}

StressScene rough(double extinction) {
    return looking_at(medium_of(unit_volume(16, roughness), static_cast<float>(extinction)));
}

StressScene in_rough(double extinction) {
    const Medium fog = medium_of(unit_volume(16, roughness), static_cast<float>(extinction));
    return stress_scene({fog}, {noon_light}, camera_from(vec3(0.5f), {0.2f, 0.4f, 0}));
}

StressScene rough_in_shadow(double width) {
    const float half = 0.5f * static_cast<float>(width);
    const Medium fog = medium_of(unit_volume(16, roughness), 2);
    return stress_scene(
        {fog}, {noon_light}, camera_from({0.6f, 0.7f, 2.6f}, vec3(0.5f)),
        {box_of({-9, 1.1f, -9}, {0.4f - half, 1.2f, 9}, -1), box_of({0.4f + half, 1.1f, -9}, {9, 1.2f, 9}, -1)});
}
}

std::vector<StressCase> stress_data() {
    constexpr std::string_view group = "grids";
    return {
        StressCase("skewed-grid", group, "a grid stretched, sheared and mirrored", "shear", "", {0, 0.5, 2, -0.5, -2},
                   seen_modes, detail, skewed,
                   {0.02, "relative RMSE of the fog's opacity against the closed form", depth_off}),
        StressCase("voxel-size", group, "voxels from micrometers to kilometers", "size", "times",
                   {10, 1e-3, 1e-4, 1e3, 1e5}, seen_modes, {}, of_size,
                   {0.01, "relative RMSE against the usual size", size_off}),
        StressCase("voxel-doubling", group, "voxels doubled and halved: no rounding, the same bits", "size", "times",
                   {2, 1.0 / 1024, 1.0 / 16384, 1024, 131072}, seen_modes, {}, of_size,
                   {1e-6, "relative RMSE against the usual size", size_off}),
        StressCase("small-grid", group, "a grid of few voxels, and of one", "side", "voxels", {7, 1}, seen_modes, {},
                   small_block,
                   {0.01, "error of the optical depth over the image", mass_off, 1e-4, "shadow-map shadow-volume"}),
        StressCase("flat-grid", group, "a sheet of few voxels seen from all sides", "thickness", "voxels", {4, 2, 1},
                   Claim::density, detail, flat_block, {0.1}),
        StressCase("ramp", group, "a ramp of density over the faces of leaves", "side", "voxels", {8, 32, 64},
                   seen_modes, {}, ramp, {1e-5, "largest error of the transmittance", ramp_off}),
        StressCase("wisps", group, "thin dense wisps get thinner than steps", "side", "voxels", {8, 16, 32, 64},
                   Claim::physical, detail, wisps, {0.1}),
        StressCase("rough-grid", group, "rough fog gets thick", "extinction", "1/m", {0.5, 3, 20, 200}, Claim::physical,
                   detail, rough, {0.1}),
        StressCase("eye-in-grid", group, "the camera is in rough fog", "extinction", "1/m", {0.5, 3, 20},
                   Claim::physical, detail, in_rough, {0.1}),
        StressCase("shaft-in-grid", group, "a narrow shaft through rough fog", "width", "m", {0.6, 0.2, 0.05},
                   Claim::density, shafts, rough_in_shadow, {0.15}),
    };
}
}
