// Scenes made in memory and estimates along rays.
#include "measure/verify/rays.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "modes/mode.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall {
bool Check::holds() const { return std::abs(measured - expected) <= tolerance; }

void Checks::add(std::string name, double measured, double expected, double tolerance, std::string basis) {
    list.push_back({topic, std::move(name), measured, expected, tolerance, std::move(basis)});
}

std::vector<Check> run_checks(std::span<const CheckGroup> groups, const VerifyControl& control) {
    Checks checks;
    double total = 0, done = 0;
    for (const CheckGroup& group : groups) total += group.share;
    for (const CheckGroup& group : groups) {
        if (control.cancel && *control.cancel) fail(ExitCode::internal, "verify", "cancelled");
        checks.topic = group.topic;
        if (control.progress)
            checks.progress = [&, done](double part) { control.progress((done + part * group.share) / total); };
        group.run(checks);
        if (control.progress) control.progress((done += group.share) / total);
    }
    return std::move(checks.list);
}

Phase forward_phase(float g) { return {PhaseKind::henyey_greenstein, g}; }

Medium even_medium(float extinction, Box box, Phase phase, vec3 albedo) {
    Medium medium;
    medium.name = "even";
    medium.optics = {extinction, albedo, phase, vec3(0)};
    medium.bounds = medium.world_bounds = box;
    return medium;
}

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

Medium grid_medium(float extinction, int voxels, const std::function<float(vec3)>& density) {
    return medium_of(unit_volume(voxels, density), extinction);
}

Medium noise_medium(float extinction, Phase phase, vec3 albedo) {
    Medium medium = grid_medium(extinction, 32, [](vec3 p) {
        const glm::uvec3 cell(p * 32.0f);
        return std::max(0.0f, 2 * to_unit(hash(cell.x, cell.y, cell.z)) - 0.8f);
    });
    medium.optics.phase = phase, medium.optics.albedo = albedo;
    return medium;
}

Light sun_light(vec3 direction, float lux) {
    Light light;
    light.name = "sun", light.kind = LightKind::sun;
    light.direction = glm::normalize(direction), light.intensity = vec3(lux);
    return light;
}

Light point_light(vec3 position, float candela) {
    Light light;
    light.name = "point", light.position = position, light.intensity = vec3(candela);
    return light;
}

Snapshot snapshot_of(std::vector<Medium> media, std::vector<Light> lights, vec3 ambient) {
    Snapshot snapshot;
    snapshot.media = std::move(media), snapshot.lights = std::move(lights), snapshot.ambient = ambient;
    snapshot.bounds = {vec3(-10), vec3(10)};
    return snapshot;
}

Mesh box_of(vec3 low, vec3 high, int material) {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.push_back(
            {corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z});
    for (const glm::uvec4 side : {glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6), glm::uvec4(0, 1, 5, 4),
                                  glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5)}) {
        mesh.triangles.push_back({side.x, side.y, side.z});
        mesh.triangles.push_back({side.x, side.z, side.w});
    }
    mesh.material = material;
    return mesh;
}

Mesh floor_of(float height, float half, int material) {
    Mesh mesh;
    mesh.positions = {{-half, height, -half}, {half, height, -half}, {half, height, half}, {-half, height, half}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = material;
    return mesh;
}

void add_surfaces(const Scene& scene, Snapshot& snapshot) {
    snapshot.scene = &scene;
    snapshot.occluders = Occluders::make(scene, 0, nullptr);
    snapshot.bounds.grow(snapshot.occluders->bounds());
}

RayLight path_light(const Snapshot& snapshot, const Ray& ray, int samples, int orders) {
    constexpr int batches = 64;
    Settings settings;
    settings.path.orders = orders;
    const ScatterFunction scatter = mode_of_all_orders().prepare(View{}, snapshot, settings, nullptr);
    std::vector<double> means(batches, 0);
    parallel_for(batches, [&](int64_t b) {
        const uint32_t batch = static_cast<uint32_t>(b);
        for (int first = 0; first < samples; first += 16) {
            const size_t count = static_cast<size_t>(std::min(16, samples - first));
            const std::vector<Ray> rays(count, ray);
            uint32_t ids[16];
            SamplePlace places[16];
            Scatter results[16];
            for (size_t i = 0; i < count; ++i) {
                const uint32_t index = static_cast<uint32_t>(first) + static_cast<uint32_t>(i);
                ids[i] = hash(index, batch, 77u), places[i] = {hash(batch, 78u), index};
            }
            scatter({rays, {ids, count}, {}, {}, {places, count}}, {results, count});
            for (size_t i = 0; i < count; ++i) means[b] += (results[i].radiance + results[i].surface).x / samples;
        }
    });
    RayLight light;
    for (const double mean : means) light.value += mean / batches;
    for (const double mean : means) light.error += (mean - light.value) * (mean - light.value);
    light.error = std::sqrt(light.error / (batches * (batches - 1)));
    return light;
}

Scatter reference_light(const Snapshot& snapshot, const Ray& ray) {
    const ScatterFunction scatter = main_mode().prepare(View{}, snapshot, settings_for(Quality::reference), nullptr);
    Scatter result;
    const uint32_t id = 7;
    scatter({{&ray, 1}, {&id, 1}, {}, {}}, {&result, 1});
    return result;
}

double integral(double a, double b, int pieces, const std::function<double(double)>& f) {
    // Abramowitz & Stegun, table 25.4.
    constexpr double x[] = {0, 0.5384693101056831, 0.9061798459386640},
                     w[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    double sum = 0;
    for (int i = 0; i < pieces; ++i) {
        const double half = 0.5 * (b - a) / pieces, middle = a + (2 * i + 1) * half;
        sum += half * w[0] * f(middle);
        for (int k = 1; k < 3; ++k) sum += half * w[k] * (f(middle - half * x[k]) + f(middle + half * x[k]));
    }
    return sum;
}
}
