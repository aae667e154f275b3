// Shadow rays of froxel-like tiles: packets of 16 against single rays, in a hall with a slatted wall (about 20 000
// triangles). Items are rays; the bar is packets ≥ 2× single.
#include "scene/mesh.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"

#include <benchmark/benchmark.h>

namespace {
using namespace tyndall;

void add_box(Mesh& mesh, vec3 low, vec3 high) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.push_back(
            {corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z});
    for (const glm::uvec4 s : {glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6), glm::uvec4(0, 1, 5, 4),
                               glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5)}) {
        mesh.triangles.push_back({first + s.x, first + s.y, first + s.z});
        mesh.triangles.push_back({first + s.x, first + s.z, first + s.w});
    }
}

// A ball of `rings` rings, as columns' capitals and furniture have.
void add_ball(Mesh& mesh, vec3 center, float radius, uint32_t rings) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    const uint32_t around = 2 * rings;
    for (uint32_t i = 0; i <= rings; ++i)
        for (uint32_t j = 0; j <= around; ++j) {
            const float polar = pi * i / rings, turn = 2 * pi * j / around;
            mesh.positions.push_back(center + radius * vec3(std::sin(polar) * std::cos(turn), std::cos(polar),
                                                            std::sin(polar) * std::sin(turn)));
        }
    for (uint32_t i = 0; i < rings; ++i)
        for (uint32_t j = 0; j < around; ++j) {
            const uint32_t a = first + i * (around + 1) + j, b = a + around + 1;
            mesh.triangles.push_back({a, b, a + 1});
            mesh.triangles.push_back({a + 1, b, b + 1});
        }
}

// A hall of 20 × 8 × 12 m: floor, walls, a wall of slats towards the sun (+x), balls on the floor.
Scene hall() {
    Scene scene;
    Mesh mesh;
    add_box(mesh, vec3(-10, -0.2f, -6), vec3(10, 0, 6));
    add_box(mesh, vec3(-10, 8, -6), vec3(10, 8.2f, 6));
    add_box(mesh, vec3(-10, 0, -6.2f), vec3(10, 8, -6));
    for (int i = 0; i < 60; ++i) {
        const float z = -6 + 0.2f * static_cast<float>(i);
        add_box(mesh, vec3(10, 0, z), vec3(10.1f, 8, z + 0.12f));
    }
    for (int i = 0; i < 20; ++i) add_ball(mesh, vec3(-9 + 2 * (i % 10), 0.8f, i < 10 ? -3 : 3), 0.8f, 15);
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({-1, 0});
    return scene;
}

const Occluders& hall_occluders() {
    static const Scene scene = hall();
    static const auto occluders = Occluders::make(scene, 0, nullptr);
    return *occluders;
}

constexpr vec3 lamp(2, 6.5f, 0.5f);

// Origins of 4×4-pixel tiles at one depth of a camera that looks down the hall: a froxel is 5 cm wide at 8 m.
std::vector<vec3> froxels() {
    std::vector<vec3> origins;
    for (int depth = 0; depth < 16; ++depth)
        for (int tile_y = 0; tile_y < 12; ++tile_y)
            for (int tile_x = 0; tile_x < 20; ++tile_x)
                for (int i = 0; i < 16; ++i) {
                    const vec2 pixel(tile_x * 4 + i % 4, tile_y * 4 + i / 4);
                    const float distance = 1 + static_cast<float>(depth) * 1.1f;
                    const vec2 slope = (pixel - vec2(40, 24)) / 80.0f;
                    origins.push_back(vec3(-9.5f, 3, 0) + distance * vec3(1, -slope.y * 0.8f, slope.x * 0.6f));
                }
    return origins;
}

Ray shadow_ray(vec3 origin, bool sun) {
    if (sun) return {origin, glm::normalize(vec3(1, 0.35f, 0.2f))};
    const vec3 towards = lamp - origin;
    const float distance = glm::length(towards);
    return {origin, towards / distance, distance * 0.9999f};
}

// Rays are made beforehand: kernels write them sixteen at a time.
std::vector<Occluders::ShadowRays> packed(const std::vector<Ray>& rays) {
    std::vector<Occluders::ShadowRays> packets(rays.size() / 16);
    for (size_t i = 0; i < rays.size(); ++i) {
        Occluders::ShadowRays& packet = packets[i / 16];
        const size_t lane = i % 16;
        packet.ox[lane] = rays[i].origin.x, packet.oy[lane] = rays[i].origin.y, packet.oz[lane] = rays[i].origin.z;
        packet.dx[lane] = rays[i].direction.x, packet.dy[lane] = rays[i].direction.y;
        packet.dz[lane] = rays[i].direction.z;
        packet.t_min[lane] = 0, packet.t_max[lane] = rays[i].t_max, packet.active[lane] = -1;
    }
    return packets;
}

std::vector<Ray> shadow_rays(bool sun) {
    std::vector<Ray> rays;
    for (const vec3 origin : froxels()) rays.push_back(shadow_ray(origin, sun));
    return rays;
}

void packets(benchmark::State& state, bool sun) {
    const Occluders& occluders = hall_occluders();
    const std::vector<Occluders::ShadowRays> rays = packed(shadow_rays(sun));
    double visible = 0;
    for (auto _ : state)
        for (const Occluders::ShadowRays& packet : rays) {
            float visibility[16];
            occluders.transmission(packet, visibility);
            for (const float v : visibility) visible += v;
        }
    const auto count = state.iterations() * static_cast<int64_t>(rays.size() * 16);
    state.SetItemsProcessed(count);
    state.counters["visible"] = visible / static_cast<double>(count);
    state.counters["triangles"] = static_cast<double>(occluders.triangle_count());
}

void singles(benchmark::State& state, bool sun) {
    const Occluders& occluders = hall_occluders();
    const std::vector<Ray> rays = shadow_rays(sun);
    double visible = 0;
    for (auto _ : state)
        for (const Ray& ray : rays) visible += occluders.transmission(ray, 0);
    const auto count = state.iterations() * static_cast<int64_t>(rays.size());
    state.SetItemsProcessed(count);
    state.counters["visible"] = visible / static_cast<double>(count);
}

BENCHMARK_CAPTURE(packets, sun, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(singles, sun, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(packets, point, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(singles, point, false)->Unit(benchmark::kMillisecond);
}
