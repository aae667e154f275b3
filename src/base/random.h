// Counter-based random numbers: a value depends only on its keys, never on earlier calls.
#pragma once
#include <cstdint>

namespace tyndall {
// Avalanching 32-bit mix (Wellons' lowbias32).
constexpr uint32_t mix(uint32_t x) {
    x ^= x >> 16, x *= 0x7feb352du;
    x ^= x >> 15, x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

constexpr uint32_t hash(uint32_t a) { return mix(a + 0x9e3779b9u); }
template<class... More> constexpr uint32_t hash(uint32_t a, More... more) {
    return mix(a + 0x9e3779b9u + 0x85ebca6bu * hash(static_cast<uint32_t>(more)...));
}

// The upper 24 bits as a number in [0, 1).
constexpr float to_unit(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

// A random number in [0, 1) for one pixel index, sample index, dimension and seed.
constexpr float random_unit(uint32_t pixel, uint32_t sample, uint32_t dimension, uint32_t seed) {
    return to_unit(hash(pixel, sample, dimension, seed));
}

// A stream of random numbers in [0, 1), for uses whose count is not known in advance.
struct RandomStream {
    uint32_t key, count = 0;
    constexpr float next() { return to_unit(hash(key, count++)); }
};

constexpr uint32_t reverse_bits(uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

// Hash-based Owen scrambling of reversed bits, the lowest first (Laine–Karras form, Vegdahl's constants).
constexpr uint32_t scramble_reversed(uint32_t x, uint32_t seed) {
    x ^= x * 0x3d20adeau, x += seed, x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    return x ^ (x * 0x53a22864u);
}

// Owen-scrambles an index, so that each power of 2 of them from 0 on is shuffled within itself.
constexpr uint32_t shuffle_index(uint32_t index, uint32_t seed) {
    return reverse_bits(scramble_reversed(reverse_bits(index), seed));
}

// Owen-scrambled point of the van der Corput sequence, as 32 bits.
constexpr uint32_t radical_inverse(uint32_t index, uint32_t seed) {
    return reverse_bits(scramble_reversed(index, seed));
}

// Second dimension of the Sobol sequence, bits reversed: the product with Pascal's triangle modulo 2, whose entry (i,
// j) is 1 where all bits of i are set in j (Lucas).
constexpr uint32_t sobol2_reversed(uint32_t index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ (index >> 16);
}

// Sample `index` of an Owen-scrambled (0,2)-sequence in [0,1)²; `seed` decorrelates uses and pixels.
struct Sample2 {
    float x, y;
};
constexpr Sample2 sample2(uint32_t index, uint32_t seed) {
    const uint32_t shuffled = shuffle_index(index, hash(seed, 0u));
    return {to_unit(radical_inverse(shuffled, hash(seed, 1u))),
            to_unit(reverse_bits(scramble_reversed(sobol2_reversed(shuffled), hash(seed, 2u))))};
}
}
