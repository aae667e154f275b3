#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_scheduler_observer.h>

#include <xmmintrin.h>

#include <memory>

namespace tyndall {
namespace {
std::unique_ptr<tbb::global_control>& limit() {
    static std::unique_ptr<tbb::global_control> control;
    return control;
}

constexpr unsigned flush_to_zero_and_denormals_are_zero = 0x8040;

struct FlushOnEntry : tbb::task_scheduler_observer {
    FlushOnEntry() { observe(true); }
    void on_scheduler_entry(bool) override { _mm_setcsr(_mm_getcsr() | flush_to_zero_and_denormals_are_zero); }
};
}

void set_thread_count(int threads) {
    const int count = threads > 0 ? threads : tbb::info::default_concurrency();
    limit() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
}

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(int64_t count, const std::function<void(int64_t)>& body) {
    tbb::parallel_for(int64_t{0}, count, [&](int64_t i) { body(i); });
}

void parallel_ranges(int64_t count, int64_t grain, const std::function<void(int64_t, int64_t)>& body) {
    tbb::parallel_for(tbb::blocked_range<int64_t>(0, count, grain),
                      [&](const tbb::blocked_range<int64_t>& range) { body(range.begin(), range.end()); });
}

void flush_denormals() {
    static FlushOnEntry observer;
    _mm_setcsr(_mm_getcsr() | flush_to_zero_and_denormals_are_zero);
}
}
