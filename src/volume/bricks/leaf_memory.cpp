#include "volume/bricks/leaf_memory.h"

#include <sys/mman.h>

#include <new>

namespace tyndall {
namespace {
constexpr size_t large_page = size_t{2} << 20;

std::align_val_t alignment(size_t bytes) { return std::align_val_t{bytes < large_page ? size_t{64} : large_page}; }
}

void* allocate_large(size_t bytes) {
    void* memory = ::operator new(bytes, alignment(bytes));
    if (bytes >= large_page) madvise(memory, bytes & ~(large_page - 1), MADV_HUGEPAGE); // best effort
    return memory;
}

void free_large(void* memory, size_t bytes) { ::operator delete(memory, alignment(bytes)); }
}
