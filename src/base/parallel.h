// Parallel loops on one shared pool. Results must not depend on which thread runs what.
#pragma once
#include <cstdint>
#include <functional>

namespace tyndall {
// Limits all parallel work of the process (this pool, Embree, OpenVDB); 0 = every core the process may use.
void set_thread_count(int threads);
int thread_count();

// Calls body(i) for 0 <= i < count, in any order, on several threads. An exception stops the loop and is rethrown.
void parallel_for(int64_t count, const std::function<void(int64_t)>& body);

// Calls body(begin, end) on pieces of at least `grain` items.
void parallel_ranges(int64_t count, int64_t grain, const std::function<void(int64_t, int64_t)>& body);

// Flush denormals to zero on this thread and on every pool thread: fog tails are full of them.
void flush_denormals();
}
