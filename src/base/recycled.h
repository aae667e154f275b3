// An allocator for arrays of the same size that are allocated every frame: freed blocks are reused as they are, which
// avoids having the operating system clear every page again.
#pragma once
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace tyndall {
// 64-byte aligned. Returned blocks are kept, up to a limit, for requests of the same size only.
void* acquire_memory(size_t bytes);
void release_memory(void* memory, size_t bytes) noexcept;

// Elements constructed without a value are left uninitialized.
template<class T> struct RecyclingAllocator {
    using value_type = T;
    RecyclingAllocator() = default;
    template<class U> RecyclingAllocator(const RecyclingAllocator<U>&) {}
    T* allocate(size_t count) { return static_cast<T*>(acquire_memory(count * sizeof(T))); }
    void deallocate(T* memory, size_t count) noexcept { release_memory(memory, count * sizeof(T)); }
    template<class U> void construct(U* at) noexcept { ::new (static_cast<void*>(at)) U; }
    template<class U, class... Values> void construct(U* at, Values&&... values) {
        ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
    }
    bool operator==(const RecyclingAllocator&) const { return true; }
};

using RecycledFloats = std::vector<float, RecyclingAllocator<float>>;
}
