// Memory handed out again.
#include "base/recycled.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace tyndall {
namespace {
constexpr size_t large = size_t{3} << 20;

TEST(Recycled, BlocksOfTheSameSizeComeBack) {
    void* first = acquire_memory(large);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(first) % 64, 0u);
    release_memory(first, large);
    void* other = acquire_memory(large + 4096);
    EXPECT_NE(other, first);
    void* second = acquire_memory(large);
    EXPECT_EQ(second, first);
    void* third = acquire_memory(large);
    EXPECT_NE(third, second);
    for (const auto& [memory, size] : {std::pair{other, large + 4096}, {second, large}, {third, large}})
        release_memory(memory, size);
}

TEST(Recycled, ValuesAreThoseAsked) {
    for (int round = 0; round < 3; ++round) {
        RecycledFloats values(large / sizeof(float), 2.5f);
        for (const float value : values) ASSERT_EQ(value, 2.5f);
        values.assign(100, 1.0f), values.resize(101, 3.0f);
        EXPECT_EQ(values[99], 1.0f);
        EXPECT_EQ(values[100], 3.0f);
        values.resize(large / sizeof(float)); // old values stay, new ones are left to chance
        EXPECT_EQ(values[100], 3.0f);
        values.assign(values.size(), 7.0f);
    }
}
}
}
