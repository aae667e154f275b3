// Parallel loops on one shared pool. Results must not depend on which thread runs what.
#pragma once
#include <cstdint>
#include <functional>
#include <initializer_list>

namespace tyndall {
// Limits all parallel work of the process (this pool, Embree, OpenVDB); 0 = every core the process may use
// (base/cores.h).
void set_thread_count(int threads);
int thread_count(); // that limit

// Calls body(i) for 0 <= i < count, in any order, on several threads. An exception stops the loop and is rethrown.
// Loops may be nested. Every thread rounds (and flushes denormals) as the caller does.
void parallel_for(int64_t count, const std::function<void(int64_t)>& body);

// Calls body(begin, end) on pieces of at least `grain` items.
void parallel_ranges(int64_t count, int64_t grain, const std::function<void(int64_t, int64_t)>& body);

// Calls all of the bodies, at the same time as far as there are threads. Who has finished helps the others with their
// loops, so no lock may be held around this. An exception stops the others and is rethrown.
void run_together(std::initializer_list<std::function<void()>> bodies);

// Flushes denormals to zero on this thread, and so in every loop it starts: fog tails are full of them. Loops inside
// libraries follow when this comes before anything has used the pool.
void flush_denormals();
}
