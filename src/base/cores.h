// How many cores this process may use: containers and batch queues often grant fewer than the machine has.
#pragma once
#include <string_view>

namespace tyndall {
// Cores in the affinity mask, capped by the cgroup's CPU quota; at least 1.
int usable_cores();

// Cores that a cgroup v2 `cpu.max` ("150000 100000") grants, rounded up; 0 when it sets no limit.
int granted_cores(std::string_view cpu_max);
}
