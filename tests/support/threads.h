// Work on a number of threads, whatever the machine has.
#pragma once
#include "base/parallel.h"

namespace tyndall {
// Loops run on so many threads while it lives.
struct Threads {
    explicit Threads(int count) : before(thread_count()) { set_thread_count(count); }
    ~Threads() { set_thread_count(before); }
    int before;
};

// What `work` returns on so many threads.
template<class Work> auto on_threads(int count, const Work& work) {
    const Threads limit(count);
    return work();
}
}
