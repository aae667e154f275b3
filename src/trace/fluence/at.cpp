// Interpolation of the fluence grid, and scattering of its light toward the eye.
#include "trace/fluence/fluence.h"

#include <algorithm>

namespace tyndall {
namespace {
// Whether no wall separates two adjacent cells, stepping along x, then y, then z.
bool is_open(const FluenceGrid& grid, ivec3 from, ivec3 to) {
    for (int axis = 0; axis < 3; ++axis) {
        ivec3 before = from;
        before[axis] = std::min(from[axis], to[axis]);
        if (from[axis] != to[axis] && grid.walls[cell_index(grid, before)] >> axis & 1) return false;
        from[axis] = to[axis];
    }
    return true;
}

// The cells whose centers surround a point, and their interpolation weights.
struct Corners {
    ivec3 cells[8];
    float shares[8];
};

// Drops the cells that are hidden from the point, and normalizes the weights.
void leave_seen(const FluenceGrid& grid, vec3 coord, ivec3 home, Corners& corners) {
    const vec4 cut = grid.cuts[cell_index(grid, home)];
    const auto before = [&](vec3 at) { return glm::dot(vec3(cut), at) + cut.w; };
    const bool behind = before(coord) < 0;
    float sum = 0;
    for (int i = 0; i < 8; ++i) {
        const ivec3 cell = corners.cells[i];
        const bool seen = behind ? cell != home && before(vec3(cell) + 0.5f) < 0 : is_open(grid, home, cell);
        if (!seen) corners.shares[i] = 0;
        sum += corners.shares[i];
    }
    for (int i = 0; i < 8; ++i)
        corners.shares[i] = sum > 0 ? corners.shares[i] / sum : corners.cells[i] == home ? 1.0f : 0.0f;
}
}

FluenceAt fluence_at(const FluenceGrid& grid, vec3 point) {
    FluenceAt at;
    if (clip(grid.bounds, point, vec3(0), {0, 1}).empty()) return at;
    const vec3 from_low = (point - grid.bounds.low) / grid.cell;
    const vec3 coord = glm::clamp(from_low - 0.5f, vec3(0), vec3(grid.size - 1));
    const ivec3 low(coord), high = glm::min(low + 1, grid.size - 1);
    const vec3 weight = coord - vec3(low);
    Corners corners;
    for (int i = 0; i < 8; ++i) {
        corners.cells[i] = {i & 4 ? high.x : low.x, i & 2 ? high.y : low.y, i & 1 ? high.z : low.z};
        corners.shares[i] =
            (i & 4 ? weight.x : 1 - weight.x) * (i & 2 ? weight.y : 1 - weight.y) * (i & 1 ? weight.z : 1 - weight.z);
    }
    if (!grid.walls.empty()) leave_seen(grid, from_low, ivec3(coord + 0.5f), corners);
    for (int i = 0; i < 8; ++i) {
        const float* values = grid.values.data() + 12 * cell_index(grid, corners.cells[i]);
        for (int c = 0; c < 3; ++c) at.fluence[c] += corners.shares[i] * values[c];
        for (int axis = 0; axis < 3; ++axis)
            for (int c = 0; c < 3; ++c) at.flux[c][axis] += corners.shares[i] * values[3 + 3 * axis + c];
    }
    return at;
}

namespace {
// Scattering by a Henyey–Greenstein lobe.
vec3 scattered_by_lobe(const FluenceAt& at, vec3 direction, float g) {
    vec3 result;
    for (int c = 0; c < 3; ++c) {
        const vec3 lobe = at.flux[c] * (g / std::max(at.fluence[c], 1e-30f));
        const float squared = std::min(glm::dot(lobe, lobe), largest_g * largest_g);
        const float q = std::max(1 + squared + 2 * glm::dot(lobe, direction), 1e-4f);
        result[c] = at.fluence[c] * (1 - squared) / (4 * pi * q * std::sqrt(q));
    }
    return result;
}

// Scattering by a Draine lobe: lowers α, and solves for the g whose mean cosine is that of the fog times that of the
// light.
vec3 scattered_by_lobe(const FluenceAt& at, vec3 direction, const PhaseLobe& lobe) {
    vec3 result;
    const float mean = static_cast<float>(mean_cosine(lobe)), given = static_cast<float>(lobe.alpha);
    for (int c = 0; c < 3; ++c) {
        const float flux = glm::length(at.flux[c]), m = std::min(flux / std::max(at.fluence[c], 1e-30f), 1.0f);
        const float alpha = 3 * m * m * given / (3 + given * (1 - m * m));
        float g = m * static_cast<float>(lobe.g);
        for (int i = 0; i < draine_steps; ++i)
            g = m * mean * (1 + alpha * (1 + 2 * g * g) / 3) / (1 + alpha * (3 + 2 * g * g) / 5);
        const float cosine = -glm::dot(at.flux[c], direction) / std::max(flux, 1e-30f);
        const float q = std::max(1 + g * g - 2 * g * cosine, 1e-4f), whole = 4 * pi * (1 + alpha * (1 + 2 * g * g) / 3);
        result[c] = at.fluence[c] * (1 - g * g) * (1 + alpha * cosine * cosine) / (whole * q * std::sqrt(q));
    }
    return result;
}
}

vec3 scattered_fluence(const FluenceAt& at, vec3 direction, const Phase& phase) {
    if (!phase.shape || phase.shape->lobes.empty()) return scattered_by_lobe(at, direction, mean_cosine(phase));
    vec3 sum(0);
    for (const PhaseLobe& lobe : phase.shape->lobes)
        sum += static_cast<float>(lobe.weight) * (lobe.alpha == 0
                                                      ? scattered_by_lobe(at, direction, static_cast<float>(lobe.g))
                                                      : scattered_by_lobe(at, direction, lobe));
    return sum;
}
}
