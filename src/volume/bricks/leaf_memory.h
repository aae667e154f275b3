// Memory for millions of leaves: in huge pages, whose first touch costs a fraction of that of small pages, and left
// uninitialized if it is filled right away.
#pragma once
#include <cstddef>
#include <memory>

namespace tyndall {
// Uninitialized memory, aligned to huge pages if at least one in size. Throws std::bad_alloc.
void* allocate_large(size_t bytes);
void free_large(void* memory, size_t bytes);

struct FreeLarge {
    size_t bytes = 0;
    void operator()(char* memory) const { free_large(memory, bytes); }
};
using LargeBytes = std::unique_ptr<char, FreeLarge>;
inline LargeBytes large_bytes(size_t bytes) { return {static_cast<char*>(allocate_large(bytes)), FreeLarge{bytes}}; }

// leaves.emplace_back(Unfilled{}) adds an uninitialized leaf; every byte must be written later.
struct Unfilled {};

template<class T> struct LeafMemory {
    using value_type = T;
    LeafMemory() = default;
    template<class U> LeafMemory(const LeafMemory<U>&) {}
    bool operator==(const LeafMemory&) const = default;

    T* allocate(size_t count) { return static_cast<T*>(allocate_large(count * sizeof(T))); }
    void deallocate(T* memory, size_t count) { free_large(memory, count * sizeof(T)); }
    void construct(T*, Unfilled) {}
};
}
