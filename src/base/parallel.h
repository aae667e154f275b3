// Parallel loops on one shared pool. Results must not depend on which thread runs what.
#pragma once
#include <cstdint>
#include <functional>
#include <initializer_list>

namespace tyndall {
// Limits all parallel work of the process (this pool, Embree, OpenVDB); 0 = every core the process may use
// (base/cores.h).
void set_thread_count(int threads);
int thread_count(); // the current limit

// Calls body(i) for 0 <= i < count, in any order, on several threads. An exception stops the loop and is rethrown.
// Loops may be nested. Every thread uses the caller's rounding and denormal modes.
void parallel_for(int64_t count, const std::function<void(int64_t)>& body);

// Calls body(begin, end) on pieces of at least `grain` items.
void parallel_ranges(int64_t count, int64_t grain, const std::function<void(int64_t, int64_t)>& body);

// Calls all bodies, concurrently as far as threads allow. A thread that has finished helps the others with their loops,
// so the caller must not hold a lock. An exception stops the others and is rethrown.
void parallel_invoke(std::initializer_list<std::function<void()>> bodies);

// Flushes denormals to zero on this thread and in every loop it starts: the thin edges of fog are full of them. Loops
// inside libraries follow only if this is called before the thread pool is first used.
void flush_denormals();
}
