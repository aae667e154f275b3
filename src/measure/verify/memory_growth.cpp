// Reads Linux's counters of a process's pages: proc(5), clear_refs and status.
#include "measure/verify/memory_growth.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace tyndall {
namespace {
// A line of /proc/self/status: "VmHWM:     1234 kB".
std::optional<double> own_pages(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        double kilobytes = 0;
        if (word == name + ":" && status >> kilobytes) return 1024 * kilobytes;
    }
    return {};
}

// Resets the peak of the resident memory to its current size.
bool reset_peak() {
    std::ofstream file("/proc/self/clear_refs");
    file << "5" << std::flush;
    return file.good();
}
}

MemoryGrowth::MemoryGrowth() {
    malloc_trim(0);
    if (reset_peak()) before_ = own_pages("VmRSS");
}

std::optional<double> MemoryGrowth::peak() const {
    const std::optional<double> highest = own_pages("VmHWM");
    if (!before_ || !highest) return {};
    return *highest > *before_ ? *highest - *before_ : 0;
}
}
