// Fits and fills grids of optical depth.
#pragma once
#include "trace/transmittance/light_depth.h"

#include <atomic>
#include <memory>
#include <span>

namespace tyndall {
// A grid fitted to the brick media, without its depths; size 0 if the light reaches none of them. `resolution`: cells
// across the longer side of the fog as seen from the light; along the light they are about as long as wide. Across,
// they are no smaller than half a voxel at resolutions up to 64 and an eighth from 256 on; along, twice that.
LightDepthGrid fitted_grid(std::span<const Medium* const> media, const Light& light, int resolution);

// Integrates the media along the columns of a fitted grid, in parallel over columns.
void fill_grid(std::span<const Medium* const> media, LightDepthGrid& grid);

// Integrates columns on first use (light_grid_simd.h). Thread-safe. Columns that were never requested hold nothing.
class GridColumns {
public:
    GridColumns(std::vector<const Medium*> media, LightDepthGrid& grid); // allocates the grid's depths
    void fill(int packet) const;                                         // sixteen columns of a row, once

    const LightDepthGrid& grid() const { return grid_; }
    int packets_across() const { return (grid_.size.x + 15) / 16; }
    bool is_filled(int packet) const {
        return states_[static_cast<size_t>(packet)].load(std::memory_order_acquire) == done;
    }

private:
    enum State : uint8_t { untouched, at_work, done };
    std::vector<const Medium*> media_;
    LightDepthGrid grid_;
    std::shared_ptr<std::vector<float>> depths_; // the grid's
    std::unique_ptr<std::atomic<uint8_t>[]> states_;
};
}
