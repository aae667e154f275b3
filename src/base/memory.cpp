#include "base/memory.h"

#include "base/control_group.h"
#include "base/process.h"

#include <sys/resource.h>

#include <algorithm>
#include <sstream>

namespace tyndall {
uint64_t available_memory() {
    uint64_t most = physical_memory();
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        most = std::min<uint64_t>(most, limit.rlim_cur);
    for (const std::string& line : control_group_lines("memory.max")) {
        uint64_t group = 0;
        if (std::istringstream(line) >> group) most = std::min(most, group);
    }
    return most - most / 8;
}
}
