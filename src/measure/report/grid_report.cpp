#include "measure/report/grid_report.h"

#include "base/error.h"
#include "base/text.h"

namespace tyndall {
std::string vector_text(vec3 v) {
    return formatted("%.4g %.4g %.4g", static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
}

std::string place_text(vec3 place, dvec3 origin) {
    const dvec3 world = origin + dvec3(place);
    return origin == dvec3(0) ? vector_text(place) : formatted("%.10g %.10g %.10g", world.x, world.y, world.z);
}

ivec3 voxels_across(const VdbGridInfo& grid) { return glm::max(grid.active_high - grid.active_low + 1, ivec3(0)); }

Box world_bounds(const VdbGridInfo& grid) {
    const ivec3 across = voxels_across(grid);
    if (across.x == 0 || across.y == 0 || across.z == 0) return {};
    return transform(mat4(grid.index_to_world), Box{vec3(grid.active_low) - 0.5f, vec3(grid.active_high) + 0.5f});
}

namespace {
std::string article_of(const std::string& noun) {
    return std::string("aeiou").find(noun[0]) == std::string::npos ? "a" : "an";
}
}

std::string kind_text(const VdbGridInfo& grid) {
    const bool quantity = grid.role != GridRole::other && grid.role != GridRole::density;
    const std::string role(grid_role_names[static_cast<size_t>(grid.role)]);
    return printable(grid.type, 80) + ", " + (grid.grid_class.empty() ? "no class" : printable(grid.grid_class, 40)) +
           (quantity ? ", looks like " + article_of(role) + " " + role : "") + ", " +
           (grid.is_fog   ? "usable as fog"
            : grid.usable ? "usable as fog where a scene names it as \"grid\""
                          : "not usable as fog: " + printable(grid.why_not));
}

namespace {
// The linear part of a transform if it is more than a positive scale along the axes.
std::string axes_text(const VdbGridInfo& grid) {
    const dmat4& m = grid.index_to_world;
    const bool along_axes =
        m[0][1] == 0 && m[0][2] == 0 && m[1][0] == 0 && m[1][2] == 0 && m[2][0] == 0 && m[2][1] == 0;
    if (along_axes && m[0][0] > 0 && m[1][1] > 0 && m[2][2] > 0) return "";
    return "x " + vector_text(vec3(m[0])) + "   y " + vector_text(vec3(m[1])) + "   z " + vector_text(vec3(m[2]));
}

std::string ranges_text(const std::vector<Interval<float>>& ranges) {
    std::vector<std::string> parts;
    for (size_t c = 0; c < ranges.size(); ++c)
        parts.push_back(formatted("%c %g to %g", "xyz"[c % 3], static_cast<double>(ranges[c].low),
                                  static_cast<double>(ranges[c].high)));
    return joined(parts, ", ");
}
}

std::vector<std::pair<std::string, std::string>> grid_rows(const VdbGridInfo& grid) {
    std::vector<std::pair<std::string, std::string>> rows;
    rows.emplace_back("active", count_text(grid.active_voxels, "voxel") + " in " + std::to_string(grid.leaves) +
                                    " leaves and " + count_text(grid.tiles, "tile") + ", " +
                                    bytes_text(static_cast<double>(grid.memory_bytes)));
    const Box bounds = world_bounds(grid);
    if (!grid.usable && bounds.empty()) return rows; // only density grids are scanned
    const ivec3 across = voxels_across(grid);
    rows.emplace_back("extent", formatted("%d x %d x %d voxels of %s m", across.x, across.y, across.z,
                                          vector_text(grid.voxel_size).c_str()));
    rows.emplace_back("world",
                      bounds.empty() ? "empty" : vector_text(bounds.low) + " to " + vector_text(bounds.high) + " m");
    if (const std::string axes = axes_text(grid); !axes.empty()) rows.emplace_back("axes", axes);
    if (grid.ranges.empty())
        rows.emplace_back("values", formatted("%g to %g, mean %g, background %g", static_cast<double>(grid.minimum),
                                              static_cast<double>(grid.maximum), static_cast<double>(grid.mean),
                                              static_cast<double>(grid.background)));
    else
        rows.emplace_back("values", ranges_text(grid.ranges));
    // Colors and scalars have no negative values; distances, velocities and other vectors do.
    const bool is_signed = grid.role == GridRole::velocity || grid.role == GridRole::level_set ||
                           (grid.role == GridRole::other && !grid.ranges.empty());
    const uint64_t negative = is_signed ? 0 : grid.negative;
    if (grid.non_finite || negative)
        rows.emplace_back("faults", std::to_string(grid.non_finite) + " not finite" +
                                        (negative ? ", " + std::to_string(negative) + " negative" : "") +
                                        ": read as 0");
    return rows;
}
}
