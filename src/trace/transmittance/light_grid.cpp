// Fits a light's grid tightly around the bricks that the light can reach.
#include "trace/transmittance/light_grid.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <cmath>

namespace tyndall {
namespace {
constexpr int64_t max_corners = 64 << 20;    // of 4 bytes: 256 MB
constexpr float max_across = 65536;          // corners along one axis
constexpr float widest_cone = 70 * pi / 180; // half angle up to which perspective columns serve a spot
constexpr float widest_view = 60 * pi / 180; // ... and a point light that has the fog to one side

// A brick in world space: a parallelepiped.
struct Block {
    vec3 center, half[3];
    float radius;

    float extent(vec3 axis) const {
        return std::abs(dot(half[0], axis)) + std::abs(dot(half[1], axis)) + std::abs(dot(half[2], axis));
    }
};

Block block_of(const BrickPool& pool, vec3 low, vec3 high) {
    Block block;
    const vec3 center = 0.5f * (low + high), size = 0.5f * (high - low);
    block.center = vec3(pool.index_to_world * vec4(center, 1));
    block.radius = 0;
    for (int axis = 0; axis < 3; ++axis) block.half[axis] = vec3(pool.index_to_world[axis]) * size[axis];
    for (int corner = 0; corner < 4; ++corner)
        block.radius = std::max(block.radius, glm::length(block.half[0] + (corner & 1 ? 1.0f : -1.0f) * block.half[1] +
                                                          (corner & 2 ? 1.0f : -1.0f) * block.half[2]));
    return block;
}

// One per brick or, with `runs`, per run of bricks along z, which has the same extent as its bricks.
std::vector<Block> blocks_of(std::span<const Medium* const> media, bool runs) {
    std::vector<Block> blocks;
    for (const Medium* medium : media) {
        const BrickPool& pool = *medium->density.bricks;
        const int32_t* row = pool.index.data();
        for (int x = 0; x < pool.size.x; ++x)
            for (int y = 0; y < pool.size.y; ++y, row += pool.size.z)
                for (int z = 0, end; z < pool.size.z; z = end) {
                    for (end = z + 1; runs && row[z] != 0 && end < pool.size.z && row[end] != 0;) ++end;
                    if (row[z] == 0) continue;
                    const vec3 low = glm::max(8.0f * vec3(x, y, z), pool.local_bounds.low);
                    const vec3 high = glm::min(8.0f * vec3(x + 1, y + 1, end), pool.local_bounds.high);
                    if (low.x < high.x && low.y < high.y && low.z < high.z) blocks.push_back(block_of(pool, low, high));
                }
    }
    return blocks;
}

// Ranges of the three grid coordinates that the fog occupies.
struct Fit {
    vec3 low{infinity}, high{-infinity};

    void grow(int axis, float from, float to) {
        low[axis] = std::min(low[axis], from), high[axis] = std::max(high[axis], to);
    }
    bool empty() const { return !(low.x < high.x && low.y < high.y && low.z < high.z); }
    float area() const { return (high.x - low.x) * (high.y - low.y); }
};

mat3 frame_along(vec3 axis, vec3 across) {
    vec3 u = across - dot(across, axis) * axis, v;
    if (glm::length(u) < 1e-3f * glm::length(across)) make_frame(axis, u, v);
    u = glm::normalize(u);
    return glm::transpose(mat3(u, glm::cross(axis, u), axis));
}

Fit fit_columns(std::span<const Block> blocks, const mat3& world_to_grid, vec3 origin) {
    const mat3 axes = glm::transpose(world_to_grid);
    Fit fit;
    for (const Block& block : blocks) {
        const vec3 center = world_to_grid * (block.center - origin);
        for (int axis = 0; axis < 3; ++axis) {
            const float extent = block.extent(axes[axis]);
            fit.grow(axis, center[axis] - extent, center[axis] + extent);
        }
    }
    return fit;
}

// Distances and tangents that the blocks cover, seen from the light. A block beside or behind the light fills the cone.
Fit fit_cone(std::span<const Block> blocks, const mat3& world_to_grid, vec3 origin, float largest_tangent) {
    const mat3 axes = glm::transpose(world_to_grid);
    const float angle = std::atan(largest_tangent);
    Fit fit;
    for (const Block& block : blocks) {
        const vec3 center = world_to_grid * (block.center - origin);
        const float distance = glm::length(center);
        const float seen = distance > block.radius ? std::asin(block.radius / distance) : pi;
        if (std::atan2(glm::length(vec2(center)), center.z) > 1.4142f * angle + seen) continue;
        fit.grow(2, distance - block.radius, distance + block.radius);
        const float depth = block.extent(axes[2]), nearest = center.z - depth;
        for (int axis = 0; axis < 2; ++axis) {
            const float a = center[axis] - block.extent(axes[axis]), b = center[axis] + block.extent(axes[axis]);
            const bool beside = nearest < 0.05f * block.radius;
            const float from = beside ? -infinity : std::min(a / nearest, a / (center.z + depth));
            const float to = beside ? infinity : std::max(b / nearest, b / (center.z + depth));
            fit.grow(axis, std::max(from, -largest_tangent), std::min(to, largest_tangent));
        }
    }
    return fit;
}

// Chooses the rotation about the axis that wastes the least area: along one of the media's own axes.
template<class FitOf>
Fit tightest(std::span<const Medium* const> media, vec3 axis, LightDepthGrid& grid, const FitOf& fit_of) {
    Fit best;
    for (const Medium* medium : media)
        for (int i = 0; i < 3; ++i) {
            const mat3 frame = frame_along(axis, vec3(medium->density.bricks->index_to_world[i]));
            const Fit fit = fit_of(frame);
            if (!best.empty() && !(fit.area() < best.area())) continue;
            best = fit;
            grid.world_to_grid = frame;
        }
    return best;
}

// Half angle of the cone around `axis` in which a light sees all blocks; π if it is inside one.
float view_angle(std::span<const Block> blocks, vec3 origin, vec3 axis) {
    float angle = 0;
    for (const Block& block : blocks) {
        const vec3 towards = block.center - origin;
        const float distance = glm::length(towards);
        if (!(distance > block.radius)) return pi;
        const float turn = std::acos(std::clamp(dot(towards, axis) / distance, -1.0f, 1.0f));
        angle = std::max(angle, turn + std::asin(block.radius / distance));
    }
    return angle;
}

// Cell sizes come in steps of a quarter octave of `unit`, and corners lie at whole multiples, so that the grid stays
// put while the fog in it drifts and its bounds change slightly from frame to frame.
float stable_size(float cell, float unit) { return unit * std::exp2(0.25f * std::round(4 * std::log2(cell / unit))); }

// The finest cells worth their memory, meters: depth is nearly linear within a voxel, so high resolutions gain nothing
// from finer ones.
struct FinestCell {
    float across = infinity, along = infinity;
};
FinestCell finest_cell(std::span<const Medium* const> media, float cells) {
    float voxel = infinity;
    for (const Medium* medium : media) {
        const vec3 size = medium->density.bricks->voxel_size;
        voxel = std::min({voxel, size.x, size.y, size.z});
    }
    const float across = voxel * std::clamp(32 / cells, 0.125f, 0.5f);
    return {across, 2 * across};
}

// Origin of the volume's own coordinates, which does not move when bricks come and go.
vec3 first_voxel(const BrickPool& pool) { return vec3(pool.index_to_world * vec4(-vec3(pool.low), 1)); }

vec3 stable_anchor(vec3 point, vec3 base, float extent, float unit) {
    const float step = unit * std::exp2(std::ceil(std::log2(extent / unit)) + 2);
    return base + glm::round((point - base) / step) * step;
}

vec3 stable_direction(vec3 towards) {
    const float longest = max_component(glm::abs(towards));
    return longest > 0 ? glm::normalize(glm::round(towards * (8 / longest))) : vec3(0, 0, 1);
}

// Corners `cell` apart; coarser when they would take too much memory.
void set_size(const Fit& fit, vec3 cell, LightDepthGrid& grid) {
    constexpr float slack = 1e-3f;
    for (;; cell *= 2.0f) {
        const vec3 low = glm::floor(fit.low / cell + slack), high = glm::ceil(fit.high / cell - slack);
        const vec3 corners = glm::max(high - low, vec3(1)) + 1.0f;
        if (max_component(corners) > max_across) continue;
        grid.size = ivec3(corners);
        if (int64_t{grid.size.x} * grid.size.y * grid.size.z > max_corners) continue;
        grid.scale = 1.0f / cell;
        grid.offset = -low;
        return;
    }
}

// Columns along the sun's rays.
void fit_sun(std::span<const Medium* const> media, std::span<const Block> blocks, const Light& light, const Box& fog,
             float cells, float voxel, LightDepthGrid& grid) {
    grid.projection = LightProjection::parallel;
    grid.position = stable_anchor(fog.center(), first_voxel(*media[0]->density.bricks),
                                  max_component(fog.size()) + blocks[0].radius, voxel);
    const Fit fit = tightest(media, light.direction, grid,
                             [&](const mat3& frame) { return fit_columns(blocks, frame, grid.position); });
    const vec3 extent = fit.high - fit.low;
    const FinestCell finest = finest_cell(media, cells);
    const float across = stable_size(std::max(std::max(extent.x, extent.y) / cells, finest.across), voxel);
    set_size(fit, vec3(across, across, std::max(across, stable_size(finest.along, voxel))), grid);
}

// Sets where the columns of a local light start. Returns the distance at which their cells are cubes, two thirds of the
// way through the fog; 0 if there is none.
float fit_distances(const Light& light, Fit& fit, LightDepthGrid& grid) {
    grid.position = light.position;
    grid.start = fit.low.z = std::max({fit.low.z, light.radius, 0.0f});
    return fit.high.z > fit.low.z ? fit.low.z + (fit.high.z - fit.low.z) * 0.667f : 0;
}

void fit_cone_grid(std::span<const Medium* const> media, std::span<const Block> blocks, const Light& light, vec3 axis,
                   float angle, float cells, float voxel, LightDepthGrid& grid) {
    grid.projection = LightProjection::perspective;
    const float tangent = std::tan(std::max(angle, 1e-3f));
    Fit fit = tightest(media, axis, grid,
                       [&](const mat3& frame) { return fit_cone(blocks, frame, light.position, tangent); });
    if (fit.empty()) return;
    const float distance = fit_distances(light, fit, grid);
    if (!(distance > 0)) return;
    const FinestCell finest = finest_cell(media, cells);
    const float wide = std::max(fit.high.x - fit.low.x, fit.high.y - fit.low.y) / cells;
    const float width = stable_size(std::max(wide, finest.across / distance), 1);
    set_size(fit, vec3(width, width, stable_size(std::max(width * distance, finest.along), voxel)), grid);
}

// All directions: the octahedral square of side 2 covers a solid angle of 4π, and half its side takes two thirds of
// `cells`. An even number of cells, as the square folds about its middle.
void fit_octahedron(std::span<const Medium* const> media, std::span<const Block> blocks, const Light& light,
                    float cells, float voxel, LightDepthGrid& grid) {
    grid.projection = LightProjection::all_around;
    Fit fit;
    fit.grow(0, -1, 1), fit.grow(1, -1, 1);
    for (const Block& block : blocks) {
        const float distance = glm::length(block.center - light.position);
        fit.grow(2, distance - block.radius, distance + block.radius);
    }
    const float distance = fit_distances(light, fit, grid);
    if (!(distance > 0)) return;
    const FinestCell finest = finest_cell(media, cells);
    const float length = distance * std::sqrt(pi); // meters per unit of the square
    const float width = 1 / std::ceil(std::min(cells * (2 / 3.0f), length / finest.across));
    set_size(fit, vec3(width, width, stable_size(std::max(width * length, finest.along), voxel)), grid);
}
}

LightDepthGrid fitted_grid(std::span<const Medium* const> media, const Light& light, int resolution) {
    LightDepthGrid grid;
    const std::vector<Block> blocks = blocks_of(media, is_distant(light));
    if (blocks.empty()) return grid;
    Box fog;
    for (const Block& block : blocks) fog.grow(block.center);
    const float cells = static_cast<float>(std::max(resolution, 1));
    const float voxel = glm::length(vec3(media[0]->density.bricks->index_to_world[0]));
    if (is_distant(light)) {
        fit_sun(media, blocks, light, fog, cells, voxel, grid);
        return grid;
    }

    // Perspective columns if one cone contains all relevant fog, else all directions.
    const bool spot = has_cone(light) && light.outer_cone <= widest_cone;
    const vec3 axis = spot ? light.direction : stable_direction(fog.center() - light.position);
    const float angle = spot ? light.outer_cone : view_angle(blocks, light.position, axis);
    if (spot || angle < widest_view)
        fit_cone_grid(media, blocks, light, axis, angle, cells, voxel, grid);
    else
        fit_octahedron(media, blocks, light, cells, voxel, grid);
    return grid;
}
}
