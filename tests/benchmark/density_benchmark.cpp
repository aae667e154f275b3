// Cost of one density sample: 4×4-pixel packets marching through a 256³ grid two thirds full, and random points.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "../tests/benchmark/density_benchmark.cpp"
#include <hwy/foreach_target.h>

#include "base/random.h"
#include "base/simd/isa.h"
#include "volume/medium_simd.h"
#include "volume/rays/steps.h"

#include <benchmark/benchmark.h>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Sum of the densities at `steps` points of each of sixteen rays.
float packet_sum(const Medium& medium, const float* origin, const float* direction, float step, int steps) {
    const Vec3s o{load(origin), load(origin + 16), load(origin + 32)};
    const Vec3s d{load(direction), load(direction + 16), load(direction + 32)};
    Floats sum = 0.0f;
    for (int k = 0; k < steps; ++k) sum = sum + density16(medium, fma(d, step * (static_cast<float>(k) + 0.5f), o));
    alignas(64) float lanes[16];
    store(sum, lanes);
    float total = 0;
    for (float lane : lanes) total += lane;
    return total;
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
namespace {
HWY_EXPORT(packet_sum);

// Blobs of fog on two thirds of the leaves; voxels of 1 m.
SparseVolume blobs() {
    SparseVolume volume;
    volume.active_low = ivec3(0), volume.active_high = ivec3(255);
    for (int x = 0; x < 32; ++x)
        for (int y = 0; y < 32; ++y)
            for (int z = 0; z < 32; ++z) {
                const double wave = std::sin(x * 0.7) + std::sin(y * 0.6 + 1) + std::sin(z * 0.5 + 2);
                if (wave < -0.55) continue;
                Leaf leaf{ivec3(x, y, z) * 8};
                for (int v = 0; v < 512; ++v) leaf.values[v] = 0.1f + 0.9f * random_unit(v, x, y, z);
                volume.leaves.push_back(leaf);
            }
    return volume;
}

const Medium& blob_medium() {
    static const Medium medium = [] {
        Medium made;
        made.density.kind = DensityKind::bricks;
        made.density.bricks = make_bricks(blobs());
        made.world_bounds = made.density.bricks->bounds;
        return made;
    }();
    return medium;
}

struct Packet {
    alignas(64) float origin[48], direction[48];
};

// Rays of 4×4 neighboring pixels each, row by row of a 256×256 picture; pixels a voxel apart in the middle of the fog.
std::vector<Packet> packets() {
    std::vector<Packet> result(64 * 64);
    const vec3 forward = glm::normalize(vec3(0.5f, -0.3f, 1)), middle(127.5f), eye = middle - 400.0f * forward;
    vec3 u, v;
    make_frame(forward, u, v);
    for (int i = 0; i < 64 * 64; ++i)
        for (int lane = 0; lane < 16; ++lane) {
            const float x = static_cast<float>(4 * (i % 64) + lane % 4) - 127.5f;
            const float y = static_cast<float>(4 * (i / 64) + lane / 4) - 127.5f;
            const vec3 direction = glm::normalize(middle + x * u + y * v - eye), origin = eye + 300.0f * direction;
            for (int axis = 0; axis < 3; ++axis) {
                result[i].origin[axis * 16 + lane] = origin[axis];
                result[i].direction[axis * 16 + lane] = direction[axis];
            }
        }
    return result;
}

void coherent_density(benchmark::State& state, const char* isa) {
    try {
        set_isa(isa);
    } catch (const std::exception& error) {
        state.SkipWithError(error.what());
        return;
    }
    const std::vector<Packet> rays = packets();
    const int steps = 285; // 200 voxels
    size_t next = 0;
    for (auto _ : state) {
        const Packet& packet = rays[next++ % rays.size()];
        benchmark::DoNotOptimize(
            HWY_DYNAMIC_DISPATCH(packet_sum)(blob_medium(), packet.origin, packet.direction, 0.7f, steps));
    }
    state.counters["per_sample"] = benchmark::Counter(static_cast<double>(state.iterations()) * steps * 16,
                                                      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    set_isa("auto");
}
BENCHMARK_CAPTURE(coherent_density, avx512, "avx512");
BENCHMARK_CAPTURE(coherent_density, avx2, "avx2");

void random_density(benchmark::State& state) {
    std::vector<float> points(48 * 4096);
    for (size_t i = 0; i < points.size(); ++i) points[i] = 256 * random_unit(static_cast<uint32_t>(i), 0, 0, 7);
    alignas(64) float density[16];
    size_t next = 0;
    for (auto _ : state) {
        const float* p = &points[(next++ % 4096) * 48];
        densities(blob_medium(), p, p + 16, p + 32, density);
        benchmark::DoNotOptimize(density[0]);
    }
    state.counters["per_sample"] = benchmark::Counter(static_cast<double>(state.iterations()) * 16,
                                                      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(random_density);

// Steps of one ray at the voxel limit, and the cost of each brick it crosses.
void step_placing(benchmark::State& state) {
    const std::vector<Packet> rays = packets();
    const StepRule rule{0.25f, 4, 1e6f, 4096, {}, 0.25f};
    std::vector<Step> steps;
    size_t next = 0;
    double bricks = 0, placed = 0;
    for (auto _ : state) {
        const Packet& packet = rays[next++ % rays.size()];
        const float *o = packet.origin, *d = packet.direction;
        steps.clear();
        append_steps({{o[0], o[16], o[32]}, {d[0], d[16], d[32]}, 200}, std::span(&blob_medium(), 1), rule, steps);
        benchmark::DoNotOptimize(steps.data());
        placed += static_cast<double>(steps.size());
        bricks += 200.0 / 8 * (std::abs(d[0]) + std::abs(d[16]) + std::abs(d[32]));
    }
    using benchmark::Counter;
    state.counters["steps"] = placed / static_cast<double>(state.iterations());
    state.counters["bricks"] = bricks / static_cast<double>(state.iterations());
    state.counters["per_brick"] = Counter(bricks, Counter::kIsRate | Counter::kInvert);
}
BENCHMARK(step_placing);

void exact_depth(benchmark::State& state) {
    const std::vector<Packet> rays = packets();
    size_t next = 0;
    for (auto _ : state) {
        const Packet& packet = rays[next++ % rays.size()];
        const float *o = packet.origin, *d = packet.direction;
        const Ray ray{{o[0], o[16], o[32]}, {d[0], d[16], d[32]}, 200};
        benchmark::DoNotOptimize(optical_depth(blob_medium(), ray));
    }
}
BENCHMARK(exact_depth)->Unit(benchmark::kMicrosecond);

void brick_building(benchmark::State& state) {
    const SparseVolume volume = blobs();
    for (auto _ : state) benchmark::DoNotOptimize(make_bricks(volume));
    state.counters["leaves"] = static_cast<double>(volume.leaves.size());
}
BENCHMARK(brick_building)->Unit(benchmark::kMillisecond);
}
}
#endif
