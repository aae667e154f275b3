#include "support/random_points.h"

#include "base/random.h"

namespace tyndall::test {
vec3 random_direction(uint32_t index, uint32_t seed) {
    const float z = 1 - 2 * random_unit(index, 0, 0, seed), turn = 2 * pi * random_unit(index, 0, 1, seed);
    const float across = std::sqrt(std::max(0.0f, 1 - z * z));
    return {across * std::cos(turn), across * std::sin(turn), z};
}

vec3 random_point(uint32_t index, uint32_t seed, const Box& box) {
    return box.low + box.size() * vec3(random_unit(index, 1, 0, seed), random_unit(index, 1, 1, seed),
                                       random_unit(index, 1, 2, seed));
}
}
