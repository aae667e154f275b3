#include "render/farm/forecast.h"

#include "base/parallel.h"
#include "base/process.h"
#include "modes/mode.h"
#include "render/frame/part.h"
#include "render/parts/plan_file.h"
#include "render/sequence/sequence.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/view.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
// The most nodes that any part holds.
size_t max_nodes(const Mode& mode, const View& view, int asked) {
    const int sections = view.batches * view.sections;
    const int64_t blocks = count_blocks(mode, view), all = int64_t{sections} * view.leaves * blocks;
    const int parts = static_cast<int>(std::min<int64_t>(asked, all)); // more are refused later
    size_t nodes = 1;
    for (int part = 1; part <= std::min(parts, 64); ++part)
        nodes =
            std::max(nodes, nodes_of(part_range(part, parts, 0, sections, view.leaves, blocks), view.leaves).size());
    return nodes;
}

// Memory of a part while it is written; a whole frame takes no more than a part of one node.
double bytes_of_part(const Mode& mode, const View& view, const Snapshot& snapshot, int parts) {
    const size_t light_parts = view.fog_parts ? snapshot.lights.size() + 3 : 0;
    const size_t channels = snapshot.scene && has_colored_fog(*snapshot.scene) ? 1 : 0;
    const size_t numbers = (fixed_sums + 3 * (light_parts + channels)) * max_nodes(mode, view, parts) + 3;
    return 2.0 * sizeof(float) * static_cast<double>(numbers) * view.size.x * view.size.y;
}

// The view at a size that takes little time, with one sample per pixel.
View small_view(View view) {
    constexpr float width = 160;
    const float share = std::min(1.0f, width / static_cast<float>(std::max(view.size.x, view.size.y)));
    view.size = glm::max(ivec2(glm::round(vec2(view.size) * share)), ivec2(1));
    view.crop_low = view.crop_high = ivec2(0);
    view.pixel_samples = view.batches = view.sections = 1, view.leaves = 0;
    return view;
}
}

double task_seconds(const FarmJob& job, double setup, double samples, int threads) {
    const double frames = static_cast<double>(std::min(static_cast<size_t>(job.chunk), job.frames.size()));
    const int own = job.engine == "slurm" ? 1 : threads; // those of a task that does not ask for any
    const double slower = static_cast<double>(threads) / (job.cpus > 0 ? job.cpus : own);
    return frames * (std::max(slower, 1.0) * setup + slower * samples / job.parts);
}

TaskForecast forecast_task(const FarmJob& job, const Scene& scene, const RenderRequest& asked,
                           std::atomic<bool>& cancel) {
    RenderRequest request = asked;
    request.frames = {job.frames.front()};
    RenderPlan plan = requested_plan(request);
    const bool counted = !job.plan_for_each_frame; // the number of samples is known
    if (counted) request.grouping = grouping_of(plan.settings.pixel.samples);
    const LoadedFrame loaded = load_first_frame(scene, request);
    View view = view_of(scene, request, plan.settings, request.frames[0]);
    if (!counted) view.leaves = 1;

    const View small = small_view(view);
    FrameStats stats;
    render_frame(*plan.mode, small, loaded.snapshot, plan.settings, {false, nullptr, &cancel, {}, {}}, stats);
    TaskForecast forecast;
    forecast.memory = static_cast<double>(peak_memory()) + bytes_of_part(*plan.mode, view, loaded.snapshot, job.parts);
    if (!counted) return forecast;
    const double pixels =
        static_cast<double>(view.size.x) * view.size.y / (static_cast<double>(small.size.x) * small.size.y);
    forecast.seconds = task_seconds(job, loaded.seconds + stats.prepare_seconds,
                                    pixels * view.pixel_samples * stats.render_seconds, thread_count());
    return forecast;
}

TaskLimits limits_of(const FarmJob& job, const TaskForecast& forecast) {
    constexpr double mebibyte = 1 << 20;
    constexpr int min_memory = 1024, min_minutes = 10;
    const int memory = std::max(static_cast<int>(std::ceil(1.5 * forecast.memory / mebibyte)), min_memory);
    TaskLimits limits{job.memory > 0 ? job.memory : memory, job.minutes};
    if (job.minutes == 0 && forecast.seconds)
        limits.minutes = static_cast<int>(std::clamp(std::ceil(4 * *forecast.seconds / 60), double{min_minutes}, 1e7));
    return limits;
}
}
