// How much memory this process may use.
#pragma once
#include <cstdint>

namespace tyndall {
// Bytes: the least of the machine's, its control group's and the process's own limit, minus an eighth.
uint64_t available_memory();
}
