// Fractal noise and whole recipes, voxels per second: run with --benchmark_filter=noise.
#include "base/error.h"
#include "base/parallel.h"
#include "base/simd/isa.h"
#include "volume/recipe/recipe.h"

#include <benchmark/benchmark.h>

#include <vector>

namespace tyndall {
namespace {
// Runs on one instruction set and one thread.
struct Setting {
    Setting(benchmark::State& state, const char* isa) : threads(thread_count()) {
        try {
            set_isa(isa);
        } catch (const Error& error) {
            state.SkipWithError(error.what());
        }
        set_thread_count(1);
    }
    ~Setting() {
        set_isa("auto");
        set_thread_count(threads);
    }
    int threads;
};

// 64³ voxels of 1/32 cell, sixteen at a time as a leaf fill visits them: squares of 4 × 4.
void noise_fill(benchmark::State& state, const char* isa) {
    const Setting setting(state, isa);
    constexpr int across = 64, count = across * across * across;
    std::vector<float> x(count), y(count), z(count), values(count);
    for (int i = 0; i < count; ++i) {
        const int square = i / 16 % 256, lane = i % 16;
        x[i] = 0.03125f * (i / 4096);
        y[i] = 0.03125f * (square / 16 * 4 + lane / 4), z[i] = 0.03125f * (square % 16 * 4 + lane % 4);
    }
    const FractalNoise noise{.octaves = static_cast<int>(state.range(0))};
    for (auto _ : state) {
        fractal_noise(noise, 0.1f, x, y, z, values);
        benchmark::DoNotOptimize(values.data());
    }
    state.SetItemsProcessed(state.iterations() * count);
}
BENCHMARK_CAPTURE(noise_fill, auto, "auto") -> Arg(1) -> Arg(4) -> Arg(5) -> Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(noise_fill, avx2, "avx2")->Arg(4)->Unit(benchmark::kMillisecond);

// A recipe from bounds to leaves. Arguments: octaves, and the threshold in hundredths (the higher, the emptier).
void noise_grow(benchmark::State& state) {
    const Setting setting(state, "auto");
    FogRecipe recipe;
    recipe.bounds = {vec3(-2), vec3(2)};
    recipe.voxel_size = 0.03125; // 128³ voxels
    recipe.noise.octaves = static_cast<int>(state.range(0));
    recipe.threshold = static_cast<float>(state.range(1)) / 100;
    for (auto _ : state) benchmark::DoNotOptimize(generate(recipe, 0).leaves.data());
    state.SetItemsProcessed(state.iterations() * 128 * 128 * 128);
}
BENCHMARK(noise_grow)->Args({4, 20})->Args({4, 50})->Args({4, 60})->Unit(benchmark::kMillisecond);

// A looping, stirred room of dust: two layers and curl noise.
void noise_grow_loop(benchmark::State& state) {
    const Setting setting(state, "auto");
    FogRecipe recipe;
    recipe.bounds = {vec3(-2), vec3(2)};
    recipe.voxel_size = 0.03125;
    recipe.threshold = 0.3f, recipe.wind = vec3(0.2f, 0, 0.1f), recipe.period = 4;
    recipe.swirl = 0.15f, recipe.swirl_speed = 0.25f;
    for (auto _ : state) benchmark::DoNotOptimize(generate(recipe, 0.7).leaves.data());
    state.SetItemsProcessed(state.iterations() * 128 * 128 * 128);
}
BENCHMARK(noise_grow_loop)->Unit(benchmark::kMillisecond);
}
}
