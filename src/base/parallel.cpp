#include "base/parallel.h"

#include "base/cores.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <xmmintrin.h>

#include <algorithm>
#include <cassert>
#include <memory>

namespace tyndall {
namespace {
std::unique_ptr<tbb::global_control>& limit() {
    static std::unique_ptr<tbb::global_control> control;
    return control;
}

// Runs a loop over [0, count) with the caller's floating-point settings. A thread that waits for the loop runs no other
// tasks, so an outer loop's body is never re-entered on the same stack and may hold a lock.
template<class Body> void run(int64_t count, const Body& body) {
    if (count <= 0) return;
    tbb::task_group_context context;
    context.capture_fp_settings();
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(tbb::blocked_range<int64_t>(0, count), body, context); });
}
}

void set_thread_count(int threads) {
    assert(threads >= 0);
    const int count = threads > 0 ? threads : usable_cores();
    limit() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
}

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(int64_t count, const std::function<void(int64_t)>& body) {
    run(count, [&](const tbb::blocked_range<int64_t>& range) {
        for (int64_t i = range.begin(); i < range.end(); ++i) body(i);
    });
}

void parallel_ranges(int64_t count, int64_t grain, const std::function<void(int64_t, int64_t)>& body) {
    // Split evenly into pieces of at least `grain` items; adjacent pieces may go to body() as one range.
    const int64_t pieces = std::max<int64_t>(count / std::max<int64_t>(grain, 1), 1);
    const int64_t size = count / pieces, larger = count % pieces;
    const auto start = [&](int64_t piece) { return piece * size + std::min(piece, larger); };
    run(count > 0 ? pieces : 0,
        [&](const tbb::blocked_range<int64_t>& range) { body(start(range.begin()), start(range.end())); });
}

// Each body is isolated and waits for its own loops only; the calling thread helps with all of them.
void parallel_invoke(std::initializer_list<std::function<void()>> bodies) {
    if (bodies.size() == 0) return;
    tbb::task_group_context context;
    context.capture_fp_settings();
    tbb::task_group group(context);
    const auto alone = [](const auto& body) { return [&body] { tbb::this_task_arena::isolate(body); }; };
    for (const std::function<void()>* body = bodies.begin() + 1; body < bodies.end(); ++body) group.run(alone(*body));
    group.run_and_wait(alone(*bodies.begin()));
}

void flush_denormals() {
    constexpr unsigned flush_to_zero_and_denormals_are_zero = 0x8040;
    _mm_setcsr(_mm_getcsr() | flush_to_zero_and_denormals_are_zero);
}
}
