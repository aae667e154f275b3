#include "trace/sampling/jitter.h"

#include "base/random.h"
#include "blue_noise_tiles.h"

namespace tyndall {
namespace {
constexpr uint32_t golden = 0x9e3779b9u; // the golden ratio's fraction
constexpr int side = 64, slices = 16;
constexpr uint32_t half_rank = 0x8000u; // the middle of the values that a 16-bit rank stands for

uint32_t ordered(ivec2 pixel) {
    constexpr uint32_t bayer[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
    return bayer[(pixel.y & 3) * 4 + (pixel.x & 3)] * 0x10000000u + 0x08000000u;
}

uint32_t interleaved(ivec2 pixel) {
    const double inner = 0.06711056 * pixel.x + 0.00583715 * pixel.y;
    const double value = 52.9829189 * (inner - std::floor(inner));
    return static_cast<uint32_t>((value - std::floor(value)) * 0x1p32);
}

size_t place(ivec2 pixel, uint32_t slice) {
    const uint32_t x = static_cast<uint32_t>(pixel.x) % side, y = static_cast<uint32_t>(pixel.y) % side;
    return (slice * side + y) * side + x;
}
}

uint32_t jitter_bits(Jitter jitter, ivec2 pixel, int frame, uint32_t seed) {
    const uint32_t number = static_cast<uint32_t>(frame), turned = number * golden;
    switch (jitter) {
    case Jitter::none:
        break;
    case Jitter::ordered:
        return ordered(pixel) + turned;
    case Jitter::white:
        return hash(static_cast<uint32_t>(pixel.x), static_cast<uint32_t>(pixel.y), number, seed);
    case Jitter::blue:
        return (uint32_t{blue_noise_tile[place(pixel, 0)]} << 16 | half_rank) + turned;
    case Jitter::interleaved:
        return interleaved(pixel) + turned;
    case Jitter::spatiotemporal:
        return uint32_t{spatiotemporal_tile[place(pixel, number % slices)]} << 16 | half_rank;
    }
    return 0x80000000u;
}
}
