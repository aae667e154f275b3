// Measures how much memory a piece of work takes.
#pragma once
#include <optional>

namespace tyndall {
// Counts from construction on. Memory that was free then, but not returned to the system, counts as taken already.
class MemoryGrowth {
public:
    MemoryGrowth();
    // Peak growth of the resident memory since construction, bytes; nullopt where the system does not report it.
    std::optional<double> peak() const;

private:
    std::optional<double> before_;
};
}
