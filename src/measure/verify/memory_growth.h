// How much memory a piece of work takes on top of what is there.
#pragma once
#include <optional>

namespace tyndall {
// Counts from its making on. Memory that was free but not given back to the system before counts as taken already.
class MemoryGrowth {
public:
    MemoryGrowth();
    // Bytes between then and the highest point since; nothing where the system does not tell.
    std::optional<double> peak() const;

private:
    std::optional<double> before_;
};
}
