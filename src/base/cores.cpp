#include "base/cores.h"

#include "base/control_group.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <vector>

namespace tyndall {
namespace {
int affinity_cores() {
    // On machines with many cores the affinity mask exceeds cpu_set_t, so retry with twice the size.
    for (int room = 1024; room <= 1 << 20; room *= 2) {
        std::vector<cpu_set_t> mask(static_cast<size_t>(room) / CPU_SETSIZE);
        const size_t bytes = mask.size() * sizeof(cpu_set_t);
        if (sched_getaffinity(0, bytes, mask.data()) == 0) return CPU_COUNT_S(bytes, mask.data());
    }
    return static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
}
}

int granted_cores(std::string_view cpu_max) {
    int64_t quota = 0, period = 0;
    const char* const end = cpu_max.data() + cpu_max.size();
    const auto first = std::from_chars(cpu_max.data(), end, quota);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != ' ') return 0; // includes "max 100000"
    const auto second = std::from_chars(first.ptr + 1, end, period);
    if (second.ec != std::errc() || quota <= 0 || period <= 0) return 0;
    return static_cast<int>(std::min<int64_t>((quota - 1) / period + 1, 1 << 20));
}

int usable_cores() {
    int cores = std::max(affinity_cores(), 1);
    for (const std::string& line : control_group_lines("cpu.max"))
        if (const int granted = granted_cores(line); granted > 0) cores = std::min(cores, granted);
    return cores;
}
}
