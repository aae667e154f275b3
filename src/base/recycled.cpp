#include "base/recycled.h"

#include <mutex>

namespace tyndall {
namespace {
constexpr size_t min_kept = size_t{1} << 20, max_kept = size_t{1} << 26, max_blocks = 12;
constexpr std::align_val_t alignment{64};

struct Block {
    void* memory;
    size_t bytes;
};
struct Store {
    std::mutex mutex;
    std::vector<Block> blocks; // most recently returned last
    Store() { blocks.reserve(max_blocks + 1); }
};
Store& store() {
    static Store& blocks = *new Store; // never destroyed: memory may be returned during program exit
    return blocks;
}
}

void* acquire_memory(size_t bytes) {
    {
        const std::lock_guard lock(store().mutex);
        std::vector<Block>& blocks = store().blocks;
        for (size_t i = blocks.size(); i-- > 0;)
            if (blocks[i].bytes == bytes) {
                void* memory = blocks[i].memory;
                blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(i));
                return memory;
            }
    }
    return ::operator new(bytes, alignment);
}

void release_memory(void* memory, size_t bytes) noexcept {
    if (bytes >= min_kept && bytes <= max_kept) {
        const std::lock_guard lock(store().mutex);
        std::vector<Block>& blocks = store().blocks;
        blocks.push_back({memory, bytes});
        if (blocks.size() <= max_blocks) return;
        memory = blocks.front().memory;
        blocks.erase(blocks.begin());
    }
    ::operator delete(memory, alignment);
}
}
