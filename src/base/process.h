// What this process has taken.
#pragma once
#include <sys/resource.h>

#include <cstdint>

namespace tyndall {
// The most memory it ever held, bytes.
inline uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}
}
