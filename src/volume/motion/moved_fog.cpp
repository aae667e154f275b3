#include "volume/motion/moved_fog.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "volume/bricks/half.h"
#include "volume/motion/cell_grid.h"
#include "volume/motion/velocity_field.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace tyndall {
namespace {
constexpr double max_voxels = 4096; // maximum displacement
constexpr int iterations = 4;       // at most, of the fixed-point backtrace
constexpr float settled = 0.01f;    // voxels

ivec3 voxel_of(size_t v) { return {static_cast<int>(v >> 6), static_cast<int>(v >> 3 & 7), static_cast<int>(v & 7)}; }

// The same bricks placed by `placed`, by default in their index coordinates.
BrickPool in_index_space(const BrickPool& pool, const dmat4& placed = dmat4(1)) {
    BrickPool result = pool;
    place(result, placed);
    return result;
}

struct VelocityRange {
    vec3 low{0}, high{0}, sum{0};
    int known = 0;

    vec3 mean() const { return known > 0 ? sum / static_cast<float>(known) : vec3(0); }
};

// Range and sum of the known velocities at all 9³ voxels of a brick.
VelocityRange range_in(const LocalVelocity& velocity, ivec3 cell) {
    VelocityRange range;
    for_each_cell(cell * 8, cell * 8 + 8, [&](ivec3 voxel) {
        vec3 v;
        if (!velocity.at(vec3(voxel), v)) return;
        range.low = range.known > 0 ? glm::min(range.low, v) : v,
        range.high = range.known > 0 ? glm::max(range.high, v) : v;
        range.sum += v, ++range.known;
    });
    return range;
}

// Bricks that may reach a cell: the sum of their mean velocities, and their number.
struct Arrivals {
    vec3 velocity{0};
    float count = 0;
};

struct MovedCells {
    CellGrid grid;
    std::vector<Arrivals> arrivals;
    std::vector<ivec3> cells; // cells that any brick may reach
};

[[noreturn]] void refuse_scattered(const std::string& what) {
    refuse(what, "its velocities spread it over too many voxels while the shutter is open: check velocity_unit, "
                 "velocity_scale and the grid's clamp");
}

// Limits the total number of (brick, reachable cell) pairs.
void check_reach(const std::vector<Box>& boxes, const std::string& what) {
    constexpr double max_notes = 1 << 28;
    double notes = 0;
    for (const Box& box : boxes) {
        const dvec3 size = dvec3(box.size()) / 8.0 + 1.0;
        notes += size.x * size.y * size.z;
    }
    if (notes > max_notes) refuse_scattered(what);
}

// Limits the result to 64 MB for small volumes, and to 16 times the input for large ones.
size_t max_cells(size_t bricks) { return std::max<size_t>(1 << 15, 16 * bricks); }

MovedCells moved_cells(const BrickPool& fog, const LocalVelocity& velocity, float time, const std::string& what) {
    const std::vector<ivec3> from = filled_cells(fog);
    std::vector<VelocityRange> ranges(from.size());
    parallel_ranges(static_cast<int64_t>(from.size()), 4, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
            ranges[i] = range_in(velocity, from[i]);
    });

    // The box each brick may reach, from its first voxel up to the first voxel of the next brick.
    std::vector<Box> boxes(from.size());
    Box all;
    for (size_t i = 0; i < from.size(); ++i) {
        const vec3 corner(from[i] * 8), a = ranges[i].low * time, b = ranges[i].high * time;
        all.grow(boxes[i] = {corner + glm::min(a, b), corner + 7.999f + glm::max(a, b)});
    }
    MovedCells moved;
    moved.grid = cells_around(dvec3(all.low), dvec3(all.high), what);
    check_reach(boxes, what);
    moved.arrivals.resize(moved.grid.count());
    for (size_t i = 0; i < from.size(); ++i)
        for_each_cell(ivec3(glm::floor(boxes[i].low / 8.0f)), ivec3(glm::floor(boxes[i].high / 8.0f)), [&](ivec3 cell) {
            Arrivals& arrivals = moved.arrivals[moved.grid.at(cell)];
            if (arrivals.count == 0) moved.cells.push_back(cell);
            if (moved.cells.size() > max_cells(from.size())) refuse_scattered(what);
            arrivals.velocity += ranges[i].mean(), arrivals.count += 1;
        });
    return moved;
}

// Backtraces x to where its fog came from; `usual` is the fallback velocity where none is known at x.
vec3 way_back(const LocalVelocity& velocity, vec3 x, vec3 usual, float time) {
    vec3 v;
    bool known = velocity.at(x, v);
    if (!known) v = usual;
    vec3 y = x - time * v;
    for (int i = 0; i < iterations && velocity.at(y, v); ++i) {
        const vec3 before = std::exchange(y, x - time * v);
        known = true;
        if (max_component(glm::abs(y - before)) < settled) break;
    }
    return known ? y : x;
}

// A row of four voxels around a point on one axis: their bricks, places in them, and weights.
struct Row {
    int brick[4], voxel[4];
    float weight[4];
};

// Weights are those of cubic convolution (Keys 1981). Points outside are moved to the layer of zeros there.
Row row_at(float local, int bricks) {
    const float inside = std::min(local > 0 ? local : 0.0f, static_cast<float>(8 * bricks - 1)); // also if not a number
    const auto first = static_cast<int>(inside);
    const float t = inside - static_cast<float>(first);
    Row row{{},
            {},
            {t * (-0.5f + t * (1 - 0.5f * t)), 1 + t * t * (-2.5f + 1.5f * t), t * (0.5f + t * (2 - 1.5f * t)),
             t * t * (-0.5f + 0.5f * t)}};
    for (int i = 0; i < 4; ++i) {
        const int voxel = std::clamp(first + i - 1, 0, 8 * bricks - 1);
        row.brick[i] = voxel / 8, row.voxel[i] = voxel % 8;
    }
    return row;
}

// Cubic interpolation limited to the range of the eight nearest voxels. A resampled peak keeps its height, which
// trilinear interpolation would lower: fire would dim, as its light depends steeply on temperature.
float sample_cubic(const BrickPool& pool, vec3 point) {
    const vec3 local = local_point(pool, point);
    const Row rows[] = {row_at(local.x, pool.size.x), row_at(local.y, pool.size.y), row_at(local.z, pool.size.z)};
    const auto value = [&](int x, int y, int z) {
        const int brick = (rows[0].brick[x] * pool.size.y + rows[1].brick[y]) * pool.size.z + rows[2].brick[z];
        const int32_t id = pool.index[static_cast<size_t>(brick)];
        if (id <= 0) return id == 0 ? 0.0f : pool.constants[static_cast<size_t>(-id - 1)];
        const int voxel = rows[0].voxel[x] * 81 + rows[1].voxel[y] * 9 + rows[2].voxel[z];
        return float_from_half(pool.values[static_cast<size_t>(id - 1) * brick_stride + static_cast<size_t>(voxel)]);
    };
    float low = infinity, high = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const float near = value(1 + (corner >> 2), 1 + (corner >> 1 & 1), 1 + (corner & 1));
        low = std::min(low, near), high = std::max(high, near);
    }
    if (!(low < high)) return low;

    float sum = 0;
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y < 4; ++y) {
            float along_z = 0;
            for (int z = 0; z < 4; ++z) along_z += rows[2].weight[z] * value(x, y, z);
            sum += rows[0].weight[x] * rows[1].weight[y] * along_z;
        }
    return std::clamp(sum, low, high);
}

void set_box(SparseVolume& volume, const CellGrid& grid) {
    if (volume.leaves.empty() && volume.tiles.empty()) return;
    volume.active_low = grid.first * 8, volume.active_high = (grid.first + grid.size) * 8 - 1;
}
}

SparseVolume moved_fog(const PlacedBricks& fog, const VelocityField& field, double time, const std::string& what) {
    SparseVolume volume;
    volume.name = what, volume.index_to_world = fog.index_to_world;
    if (!(fog.bricks->highest > 0)) return volume;
    const vec3 sizes = fog.bricks->voxel_size;
    const double voxels = std::abs(time) * double{field.fastest} / double{std::min({sizes.x, sizes.y, sizes.z})};
    if (!(voxels <= max_voxels))
        refuse(what,
               formatted("its velocity moves it by up to %.3g voxels while the shutter is open: check velocity_unit "
                         "and velocity_scale",
                         voxels));

    const LocalVelocity velocity(field, fog.index_to_world);
    const BrickPool bricks = in_index_space(*fog.bricks);
    const auto t = static_cast<float>(time);
    const MovedCells moved = moved_cells(bricks, velocity, t, what);
    volume.leaves = filled_leaves(moved.cells, what, [&](ivec3 cell, Leaf& leaf) {
        const Arrivals& arrivals = moved.arrivals[moved.grid.at(cell)];
        const vec3 usual = arrivals.velocity / arrivals.count;
        for (size_t v = 0; v < 512; ++v)
            leaf.values[v] = sample_cubic(bricks, way_back(velocity, vec3(leaf.origin + voxel_of(v)), usual, t));
    });
    set_box(volume, moved.grid);
    return volume;
}

namespace {
// One of the two blended grids, resampled on the voxels of the result.
struct BlendPart {
    float weight = 0;
    BrickPool bricks;  // in index coordinates of the result
    bool same = false; // shares the result's voxel grid
    std::vector<ivec3> cells;

    // The value over a cell if it is known to be constant there.
    std::optional<float> even(ivec3 cell) const {
        if (bricks.empty()) return 0.0f;
        if (!same) return {};
        const ivec3 at = cell - bricks.low / 8;
        for (int axis = 0; axis < 3; ++axis)
            if (at[axis] < 0 || at[axis] >= bricks.size[axis]) return 0.0f;
        const int32_t id = bricks.index[size_t((at.x * bricks.size.y + at.y) * bricks.size.z + at.z)];
        if (id > 0) return {};
        return id == 0 ? 0.0f : bricks.constants[static_cast<size_t>(-id - 1)];
    }
};

// Appends the cells of the result that a cell of another voxel grid overlaps.
void append_cells(const mat4& to_result, ivec3 cell, std::vector<ivec3>& cells) {
    const Box box = transform(to_result, Box{vec3(cell * 8), vec3(cell * 8 + 8)});
    for_each_cell(ivec3(glm::floor(box.low / 8.0f)), ivec3(glm::floor(box.high / 8.0f)),
                  [&](ivec3 reached) { cells.push_back(reached); });
}

BlendPart part_of(const PlacedBricks& fog, float weight, const dmat4& index_to_world) {
    BlendPart part;
    part.weight = weight;
    if (!fog.bricks) return part;
    const dmat4 place = glm::inverse(index_to_world) * fog.index_to_world;
    part.same = fog.index_to_world == index_to_world;
    part.bricks = part.same ? in_index_space(*fog.bricks) : in_index_space(*fog.bricks, place);
    for (const ivec3 cell : filled_cells(*fog.bricks))
        part.same ? part.cells.push_back(cell) : append_cells(mat4(place), cell, part.cells);
    return part;
}

double voxel_volume(const PlacedBricks& fog) { return std::abs(glm::determinant(glm::dmat3(fog.index_to_world))); }
}

SparseVolume blended_fog(const PlacedBricks& a, const PlacedBricks& b, float share, const std::string& what) {
    SparseVolume volume;
    const bool on_b = !a.bricks || (b.bricks && voxel_volume(b) < (1 - 1e-9) * voxel_volume(a));
    volume.name = what, volume.index_to_world = on_b ? b.index_to_world : a.index_to_world;
    const float unit = a.bricks ? b.unit / a.unit : 1;
    const BlendPart parts[] = {part_of(a, 1 - share, volume.index_to_world),
                               part_of(b, share * unit, volume.index_to_world)};

    // Collect each cell once.
    dvec3 low(infinity), high(-infinity);
    for (const BlendPart& part : parts)
        for (const ivec3 cell : part.cells)
            low = glm::min(low, dvec3(cell * 8)), high = glm::max(high, dvec3(cell * 8 + 7));
    if (!(low.x <= high.x)) return volume;
    const CellGrid grid = cells_around(low, high, what);
    std::vector<uint8_t> taken(grid.count());
    std::vector<ivec3> cells;
    for (const BlendPart& part : parts)
        for (const ivec3 cell : part.cells) {
            if (std::exchange(taken[grid.at(cell)], uint8_t{1})) continue;
            const auto first = parts[0].even(cell), second = parts[1].even(cell);
            if (!first || !second)
                cells.push_back(cell);
            else if (const float value = parts[0].weight * *first + parts[1].weight * *second; value > 0)
                volume.tiles.push_back({cell * 8, cell * 8 + 7, value});
        }

    volume.leaves = filled_leaves(cells, what, [&](ivec3, Leaf& leaf) {
        for (size_t v = 0; v < 512; ++v) {
            const vec3 at(leaf.origin + voxel_of(v));
            leaf.values[v] = parts[0].weight * sample_density(parts[0].bricks, at) +
                             parts[1].weight * sample_density(parts[1].bricks, at);
        }
    });
    set_box(volume, grid);
    return volume;
}
}
