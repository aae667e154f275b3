// Fog from grids: bad voxels, odd transforms and sizes, tiles, sheets and single voxels.
#include "measure/stress_trial.h"

#include "base/random.h"
#include "volume/vdb_fog.h"

namespace tyndall {
namespace {
constexpr std::string_view sampled = "march froxel shadow-map shadow-volume path";
constexpr std::string_view seen = "march froxel shadow-map shadow-volume";
constexpr std::string_view all = "march froxel shadow-map shadow-volume cone path";
constexpr std::string_view detail = "longer than the detail|detail finer than a|optical depths deep|drawn as even fog";

const Light noon = sun_light({0.3f, -1, -0.2f}, 10);

// n^3 voxels that fill the unit box.
SparseVolume unit_volume(int n, const std::function<float(vec3)>& density) {
    SparseVolume volume;
    volume.index_to_world = glm::scale(dmat4(1), dvec3(1.0 / n));
    volume.index_to_world[3] = glm::dvec4(dvec3(0.5 / n), 1);
    volume.active_low = ivec3(0), volume.active_high = ivec3(n - 1);
    for (int x = 0; x < n; x += 8)
        for (int y = 0; y < n; y += 8)
            for (int z = 0; z < n; z += 8) {
                Leaf& leaf = volume.leaves.emplace_back(Leaf{{x, y, z}, {}});
                for (int i = 0; i < 512; ++i) {
                    const ivec3 voxel = leaf.origin + ivec3(i / 64, i / 8 % 8, i % 8);
                    leaf.values[static_cast<size_t>(i)] = density((vec3(voxel) + 0.5f) / static_cast<float>(n));
                }
            }
    return volume;
}

Medium medium_of(const SparseVolume& volume, float extinction) {
    Medium medium = even_medium(extinction, everywhere());
    medium.name = "grid", medium.kind = DensityKind::bricks;
    medium.bricks = make_bricks(volume);
    medium.world_bounds = medium.bounds = medium.bricks->bounds;
    return medium;
}

StressScene looking_at(Medium medium) {
    return stress_scene({std::move(medium)}, {noon}, camera_from({0.6f, 0.7f, 2.6f}, vec3(0.5f)));
}

float blob(vec3 p) { return std::exp(-24 * glm::dot(p - 0.5f, p - 0.5f)); }
float roughness(vec3 p) {
    const glm::uvec3 cell(p * 16.0f);
    return std::max(0.0f, 2 * to_unit(hash(cell.x, cell.y, cell.z)) - 0.6f);
}

// A grid as a file holds it, a share of whose voxels is `value`; and what is left when those are taken as empty.
struct BadGrid {
    SparseVolume mended, emptied;
    bool counted = false;
};
BadGrid bad_grid(double share, std::initializer_list<float> values) {
    BadGrid bad;
    bad.emptied = unit_volume(16, [](vec3 p) { return blob(p); });
    DecodedTree tree;
    tree.leaves = bad.emptied.leaves;
    tree.active.assign(tree.leaves.size(), VoxelMask{});
    uint64_t count = 0;
    for (size_t l = 0; l < tree.leaves.size(); ++l) {
        tree.active[l].fill(~uint64_t{0});
        for (uint32_t v = 0; v < 512; ++v) {
            if (random_unit(static_cast<uint32_t>(l), v, 0, 5) >= static_cast<float>(share)) continue;
            tree.leaves[l].values[v] = values.begin()[count++ % values.size()];
            bad.emptied.leaves[l].values[v] = 0;
        }
    }
    VdbReadReport report;
    make_fog(std::move(tree), bad.mended, report, "a grid");
    bad.mended.index_to_world = bad.emptied.index_to_world;
    bad.counted = report.non_finite + report.negative == count;
    return bad;
}

StressScene not_finite(double share) {
    return looking_at(medium_of(bad_grid(share, {NAN, INFINITY, -INFINITY}).mended, 3));
}
StressScene below_zero(double share) { return looking_at(medium_of(bad_grid(share, {-1, -1e30f, -1e-30f}).mended, 3)); }

double mend_off(Trial& trial) {
    const BadGrid bad = bad_grid(trial.value, {-1});
    const double off = difference(trial.render(), trial.render(looking_at(medium_of(bad.emptied, 3))));
    return bad.counted ? off : infinity;
}

// A round cloud, scaled (1, 2, 5) and sheared; a mirror for negative values.
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
    return stress_scene({medium_of(volume, 1)}, {noon}, camera_from(center + vec3(1, 2, 9), center, 0.35f));
}

// In the cloud's own space each ray crosses exp(-24 r^2): its depth is sqrt(pi / 24) exp(-24 h^2) by its stretch there.
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
    return stress_scene({medium_of(volume, 3 / s)}, {noon}, camera);
}
StressScene of_size(double size) { return sized(static_cast<float>(size)); }
double size_off(Trial& trial) { return difference(trial.render(), trial.render(sized(1))); }

StressScene tiled(double side) {
    const int n = static_cast<int>(side);
    SparseVolume volume = unit_volume(8, [](vec3) { return 0.5f; });
    volume.index_to_world = glm::scale(dmat4(1), dvec3(1.0 / n));
    volume.leaves.clear();
    volume.tiles = {{ivec3(0), ivec3(n - 1), 0.5f}}, volume.active_high = ivec3(n - 1);
    return looking_at(medium_of(volume, 2));
}
double tiles_off(Trial& trial) {
    SparseVolume dense = unit_volume(static_cast<int>(trial.value), [](vec3) { return 0.5f; });
    dense.index_to_world[3] = glm::dvec4(0, 0, 0, 1);
    return difference(trial.render(), trial.render(looking_at(medium_of(dense, 2))));
}

// Of a picture that shows a block and the voxel around it in which it fades.
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
    return stress_scene({medium_of(volume, 8)}, {noon},
                        flat_camera(center + vec3(0, 0, 3), center, block_height(size)));
}
StressScene small_block(double side) { return block(ivec3(static_cast<int>(side))); }
StressScene flat_block(double layers) { return block({6, 6, static_cast<int>(layers)}); }

// Optical depth over the whole picture: each voxel counts for its volume.
double mass_off(Trial& trial) {
    const Layers layers = trial.render();
    const double side = trial.value / 16, pixel = (side + 2.0 / 16) / layers.size.y;
    double sum = 0;
    for (const float share : layers.transmittance.pixels) sum -= std::log(std::max(share, 1e-30f)) * pixel * pixel;
    return std::abs(sum / (8 * side * side * side) - 1);
}

StressScene nothing(double n) {
    SparseVolume volume = unit_volume(8, [](vec3) { return 0.0f; });
    if (n == 0) volume.leaves.clear(), volume.active_high = ivec3(-1);
    Medium medium = medium_of(volume, 2);
    return looking_at(medium);
}
double anything(Trial& trial) {
    const Layers layers = trial.render();
    double most = most_of(layers.inscatter);
    for (const float share : layers.transmittance.pixels) most = std::max(most, std::abs(1.0 - share));
    return most;
}

// Density grows along x, over the faces of all leaves.
StressScene ramp(double voxels) {
    const Medium fog = medium_of(unit_volume(static_cast<int>(voxels), [](vec3 p) { return p.x; }), 2);
    return stress_scene({fog}, {noon}, flat_camera({0.5f, 0.5f, 3}, vec3(0.5f), 0.4f));
}
double ramp_off(Trial& trial) {
    const Layers layers = trial.render();
    double most = 0;
    for (int x = 0; x < layers.size.x; ++x) {
        const float at = 0.5f + ((static_cast<float>(x) + 0.5f) / static_cast<float>(layers.size.x) - 0.5f) * 0.4f *
                                    static_cast<float>(layers.size.x) / static_cast<float>(layers.size.y);
        // The last half voxel at either end fades, but every voxel counts whole.
        most = std::max(most, std::abs(layers.transmittance.at(x, 13) - std::exp(-2.0 * at)));
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
    return stress_scene({fog}, {noon}, camera_from(vec3(0.5f), {0.2f, 0.4f, 0}));
}

StressScene rough_in_shadow(double width) {
    const float half = 0.5f * static_cast<float>(width);
    const Medium fog = medium_of(unit_volume(16, roughness), 2);
    return stress_scene(
        {fog}, {noon}, camera_from({0.6f, 0.7f, 2.6f}, vec3(0.5f)),
        {box_of({-9, 1.1f, -9}, {0.4f - half, 1.2f, 9}, -1), box_of({0.4f + half, 1.1f, -9}, {9, 1.2f, 9}, -1)});
}
}

std::vector<StressCase> stress_data() {
    constexpr std::string_view group = "grids";
    return {
        StressCase("bad-voxels", group, "NaN and infinity in a grid count as empty", "share", "", {0.001, 0.1, 0.9},
                   seen, "", not_finite, {0, "difference from empty voxels", mend_off}),
        StressCase("negative-voxels", group, "negative density in a grid counts as empty", "share", "",
                   {0.001, 0.1, 0.9}, seen, "", below_zero, {0, "difference from empty voxels", mend_off}),
        StressCase("skewed-grid", group, "a grid stretched, sheared and mirrored", "shear", "", {0, 0.5, 2, -0.5, -2},
                   seen, detail, skewed, {0.02, "relative RMSE of what fog takes, against the closed form", depth_off}),
        StressCase("voxel-size", group, "voxels from micrometres to kilometres", "size", "times",
                   {10, 1e-3, 1e-4, 1e3, 1e5}, seen, "", of_size,
                   {0.01, "relative RMSE against the usual size", size_off}),
        StressCase("tiles", group, "a grid of one tile is the same as of many voxels", "side", "voxels", {8, 32, 64},
                   seen, "", tiled, {1e-5, "relative RMSE against voxels", tiles_off}),
        StressCase("small-grid", group, "a grid of few voxels, and of one", "side", "voxels", {8, 2, 1}, seen, "",
                   small_block, {0.01, "error of the optical depth over the picture", mass_off}),
        StressCase("flat-grid", group, "a sheet of few voxels seen from all sides", "thickness", "voxels", {4, 2, 1},
                   sampled, detail, flat_block, {0.1}),
        StressCase("empty-grid", group, "a grid of zeros, and of nothing", "voxels", "", {512, 0},
                   "march froxel shadow-map shadow-volume cone billboard path", "", nothing,
                   {0, "most light scattered or taken away", anything}),
        StressCase("ramp", group, "a ramp of density over the faces of leaves", "side", "voxels", {8, 32, 64}, seen, "",
                   ramp, {0.01, "largest error of the transmittance", ramp_off}),
        StressCase("wisps", group, "thin dense wisps get thinner than steps", "side", "voxels", {8, 16, 32, 64}, all,
                   detail, wisps, {0.1}),
        StressCase("rough-grid", group, "rough fog gets thick", "extinction", "1/m", {0.5, 3, 20, 200}, all, detail,
                   rough, {0.1}),
        StressCase("eye-in-grid", group, "the eye stands in rough fog", "extinction", "1/m", {0.5, 3, 20}, all, detail,
                   in_rough, {0.1}),
        StressCase(
            "shaft-in-grid", group, "a narrow shaft through rough fog", "width", "m", {0.6, 0.2, 0.05}, sampled,
            "longer than the detail|detail finer than a|optical depths deep|shafts are as coarse|their edges show",
            rough_in_shadow, {0.15}),
    };
}
}
