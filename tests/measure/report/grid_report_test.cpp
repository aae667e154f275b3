// What info and the viewer say of a grid.
#include "measure/report/grid_report.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace tyndall {
namespace {
std::string row_of(const VdbGridInfo& grid, std::string_view name) {
    for (const auto& [row, value] : grid_rows(grid))
        if (row == name) return value;
    return {};
}

VdbGridInfo grid_with(GridRole role, uint64_t non_finite, uint64_t negative) {
    VdbGridInfo grid;
    grid.usable = true, grid.role = role;
    grid.active_low = ivec3(0), grid.active_high = ivec3(7);
    grid.non_finite = non_finite, grid.negative = negative;
    return grid;
}

TEST(GridReport, FaultsOfWhatHasASignAreThoseNotFinite) {
    EXPECT_EQ(row_of(grid_with(GridRole::density, 0, 0), "faults"), "");
    EXPECT_EQ(row_of(grid_with(GridRole::density, 2, 3), "faults"), "2 not finite, 3 negative: read as 0");
    EXPECT_EQ(row_of(grid_with(GridRole::color, 0, 3), "faults"), "0 not finite, 3 negative: read as 0");
    EXPECT_EQ(row_of(grid_with(GridRole::velocity, 2, 3), "faults"), "2 not finite: read as 0");
    for (const GridRole role : {GridRole::velocity, GridRole::level_set})
        EXPECT_EQ(row_of(grid_with(role, 0, 3), "faults"), "");
    VdbGridInfo normals = grid_with(GridRole::other, 0, 3);
    normals.ranges.resize(3);
    EXPECT_EQ(row_of(normals, "faults"), "");
}
}
}
