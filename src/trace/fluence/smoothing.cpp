#include "trace/fluence/smoothing.h"

#include "base/parallel.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int levels = 3;

void for_cells(size_t count, const auto& visit) {
    parallel_ranges(static_cast<int64_t>(count), 4096, [&](int64_t begin, int64_t end) {
        for (int64_t cell = begin; cell < end; ++cell) visit(static_cast<size_t>(cell));
    });
}

// Filters along an axis by 1/4, 1/2, 1/4, taps `stride` apart, `count` numbers per cell; reflects at walls and borders.
template<size_t count> void smooth_along(int axis, int stride, const FluenceGrid& grid, std::vector<float>& values) {
    const int across = (axis + 1) % 3, up = (axis + 2) % 3, length = grid.size[axis];
    parallel_for(int64_t{grid.size[across]} * grid.size[up], [&](int64_t line) {
        const auto cell_at = [&](int i) {
            ivec3 cell(0);
            cell[across] = static_cast<int>(line) / grid.size[up], cell[up] = static_cast<int>(line) % grid.size[up];
            cell[axis] = i;
            return cell_index(grid, cell);
        };
        std::vector<float> before(static_cast<size_t>(length) * count);
        std::vector<int> walls(static_cast<size_t>(length), 0); // walls before each cell
        for (int i = 0; i < length; ++i) {
            std::copy_n(values.data() + count * cell_at(i), count, before.data() + count * static_cast<size_t>(i));
            if (i > 0 && !grid.walls.empty())
                walls[static_cast<size_t>(i)] =
                    walls[static_cast<size_t>(i) - 1] + (grid.walls[cell_at(i - 1)] >> axis & 1);
        }
        const auto seen = [&](int from, int to) {
            const bool open =
                to >= 0 && to < length && walls[static_cast<size_t>(to)] == walls[static_cast<size_t>(from)];
            return before.data() + count * static_cast<size_t>(open ? to : from);
        };
        for (int i = 0; i < length; ++i) {
            const float *low = seen(i, i - stride), *here = seen(i, i), *high = seen(i, i + stride);
            float* to = values.data() + count * cell_at(i);
            for (size_t k = 0; k < count; ++k) to[k] = 0.25f * (low[k] + high[k]) + 0.5f * here[k];
        }
    });
}

// Along all axes.
template<size_t count> void smooth_by(int stride, const FluenceGrid& grid, std::vector<float>& values) {
    for (int axis = 0; axis < 3; ++axis) smooth_along<count>(axis, stride, grid, values);
}

// Power of a detail level, [2 · cell + which]: of the whole detail, and of its noise.
std::vector<float> powers_of(const std::vector<float>& finer, const std::vector<float>& coarser,
                             const std::vector<float>& finer_noise, const std::vector<float>& coarser_noise) {
    std::vector<float> powers(finer.size() / 6);
    for_cells(finer.size() / 12, [&](size_t cell) {
        float all = 0, noise = 0;
        for (size_t i = 12 * cell; i < 12 * cell + 12; ++i) {
            const float detail = finer[i] - coarser[i], difference = finer_noise[i] - coarser_noise[i];
            all += detail * detail, noise += difference * difference;
        }
        powers[2 * cell] = all, powers[2 * cell + 1] = noise;
    });
    return powers;
}
}

void smooth(std::vector<float> difference, FluenceGrid& grid) {
    const size_t cells = grid.values.size() / 12;
    std::vector<float> details(grid.values.size(), 0.0f), kept(cells, 0.0f); // kept: fraction of the current detail
    for (int level = 0; level < levels; ++level) {
        const int stride = 1 << level;
        std::vector<float> coarser = grid.values, coarser_noise = difference;
        smooth_by<12>(stride, grid, coarser), smooth_by<12>(stride, grid, coarser_noise);
        std::vector<float> powers = powers_of(grid.values, coarser, difference, coarser_noise);
        for (int around = 1; around <= stride; around *= 2) smooth_by<2>(around, grid, powers);
        // No less than of finer details: so each cell is a convex combination of the filters, and light stays positive.
        for_cells(cells, [&](size_t cell) {
            const float all = powers[2 * cell], noise = powers[2 * cell + 1];
            if (all > 0) kept[cell] = std::max(kept[cell], 1 - noise / all);
            for (size_t i = 12 * cell; i < 12 * cell + 12; ++i)
                details[i] += kept[cell] * (grid.values[i] - coarser[i]);
        });
        grid.values = std::move(coarser), difference = std::move(coarser_noise);
    }
    for (size_t i = 0; i < details.size(); ++i) grid.values[i] += details[i];
}
}
