// Arrays of the same size made frame after frame: memory given back is handed out again as it is, without a visit to
// the system, which would have to clear every page of it anew.
#pragma once
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace tyndall {
// At least 64-byte aligned. What is given back is kept up to a limit, for blocks of the same size only.
void* take_memory(size_t bytes);
void give_memory(void* memory, size_t bytes) noexcept;

// Elements that are given no value have none: what lay there before.
template<class T> struct RecyclingAllocator {
    using value_type = T;
    RecyclingAllocator() = default;
    template<class U> RecyclingAllocator(const RecyclingAllocator<U>&) {}
    T* allocate(size_t count) { return static_cast<T*>(take_memory(count * sizeof(T))); }
    void deallocate(T* memory, size_t count) noexcept { give_memory(memory, count * sizeof(T)); }
    template<class U> void construct(U* at) noexcept { ::new (static_cast<void*>(at)) U; }
    template<class U, class... Values> void construct(U* at, Values&&... values) {
        ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
    }
    bool operator==(const RecyclingAllocator&) const { return true; }
};

using RecycledFloats = std::vector<float, RecyclingAllocator<float>>;
}
