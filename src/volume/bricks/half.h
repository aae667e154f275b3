// Conversion between nonnegative floats and half floats (IEEE 754 binary16) without special instructions.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tyndall {
inline constexpr float largest_half = 65504;
inline constexpr float smallest_half = 0x1p-24f;

// Nearest half, ties to even, subnormals kept; clamped to the largest half; negative values and NaN give 0.
inline uint16_t half_from_float(float value) {
    value = value > 0 ? value : 0.0f;
    value = value < largest_half ? value : largest_half;

    // Below 2^-14, adding ½ leaves the 10 bits of a subnormal in the low bits of the float, rounded by the addition.
    const uint32_t subnormal = std::bit_cast<uint32_t>(value + 0.5f) - std::bit_cast<uint32_t>(0.5f);

    // Above, rebias the exponent by 112 and drop 13 bits; adding half of the last kept bit, minus one if that bit is
    // even, rounds to nearest even.
    const uint32_t bits = std::bit_cast<uint32_t>(value);
    const uint32_t normal = (bits - (112u << 23) + 0xfff + ((bits >> 13) & 1)) >> 13;
    return static_cast<uint16_t>(value < 0x1p-14f ? subnormal : normal);
}

// Converts an array. Returns the smallest and largest stored value.
struct HalfRange {
    uint16_t low = 0, high = 0;
};
HalfRange halves_from_floats(const float* from, size_t count, uint16_t* to);

inline float float_from_half(uint16_t half) {
    return half < 0x400 ? static_cast<float>(half) * smallest_half
                        : std::bit_cast<float>((static_cast<uint32_t>(half) << 13) + (112u << 23));
}
}
