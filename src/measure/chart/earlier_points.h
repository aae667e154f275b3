// Points of a chart that an earlier run left in its directory. Internal to the chart.
#pragma once
#include "base/json/json.h"
#include "measure/chart/point.h"
#include "render/image/view_transform.h"

#include <optional>

namespace tyndall {
// Mode, settings and every field; numbers that are not finite are null.
Json json_of_point(const ChartPoint& point);

// Hash of all that a point's numbers depend on, except the machine and its load.
std::string point_hash(const ChartStage& stage, const ChartRung& rung, const std::string& references,
                       FileHashes& files);

// The stored point with that hash, if its images exist too. Damaged files count as missing.
std::optional<ChartPoint> cached_point(const std::filesystem::path& directory, const ChartRung& rung,
                                       const std::string& hash);

// Writes a point's images, then its numbers. Throws Error (unwritable).
void keep_point(const std::filesystem::path& directory, const MeasuredPoint& measured, const std::string& hash,
                const Display& display);
}
