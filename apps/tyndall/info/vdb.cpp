// tyndall info: OpenVDB files.
#include "common.h"
#include "measure/report/grid_report.h"
#include "reports.h"

#include "base/error.h"
#include "scene/file/medium_words.h"

namespace tyndall {
namespace {
Json grid_json(const VdbGridInfo& grid) {
    const ivec3 across = voxels_across(grid);
    std::vector<double> matrix;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) matrix.push_back(grid.index_to_world[column][row]);
    return json_object({{"name", grid.name},
                        {"grid", grid.key},
                        {"type", grid.type},
                        {"class", grid.grid_class},
                        {"looks_like", grid_role_names[static_cast<size_t>(grid.role)]},
                        {"usable", grid.usable},
                        {"is_fog", grid.is_fog},
                        {"why_not", grid.why_not},
                        {"voxels", std::vector{across.x, across.y, across.z}},
                        {"voxel_size", grid.voxel_size},
                        {"bounds", world_bounds(grid)},
                        {"index_to_world", matrix},
                        {"active_voxels", grid.active_voxels},
                        {"leaves", grid.leaves},
                        {"tiles", grid.tiles},
                        {"minimum", grid.minimum},
                        {"maximum", grid.maximum},
                        {"mean", grid.mean},
                        {"background", grid.background},
                        {"ranges", json_list(grid.ranges,
                                             [](Interval<float> range) {
                                                 return Json(std::vector{range.low, range.high});
                                             })},
                        {"non_finite", grid.non_finite},
                        {"negative", grid.negative},
                        {"memory_bytes", grid.memory_bytes},
                        {"metadata", json_object({grid.metadata.begin(), grid.metadata.end()})}});
}

std::string metadata_lines(const std::vector<std::pair<std::string, std::string>>& metadata, const char* indent) {
    std::string text;
    for (const auto& [name, value] : metadata)
        text += formatted("%s%s = %s\n", indent, printable(name, 80).c_str(), printable(value, 200).c_str());
    return text;
}

std::string grid_text(const VdbGridInfo& grid) {
    std::string text = "  " + printable(grid.key, 80) + ": " + kind_text(grid) + "\n";
    for (const auto& [name, value] : grid_rows(grid)) text += formatted("    %-13s %s\n", name.c_str(), value.c_str());

    // Leaves out metadata that the rows above already show.
    std::vector<std::pair<std::string, std::string>> more;
    for (const auto& entry : grid.metadata)
        if (!entry.first.starts_with("file_") && entry.first != "name" && entry.first != "class") more.push_back(entry);
    return text + metadata_lines(more, "    ");
}
}

std::string vdb_report(const std::filesystem::path& file, bool json) {
    const VdbInfo info = vdb_info(file);
    if (json) {
        return json_line({{"file", file.native()},
                          {"kind", "vdb"},
                          {"format", info.format},
                          {"file_version", info.file_version},
                          {"library_version", info.library_version},
                          {"compression", info.compression},
                          {"metadata", json_object({info.metadata.begin(), info.metadata.end()})},
                          {"grids", json_list(info.grids, grid_json)},
                          {"scene_medium", medium_text(file, info)},
                          {"scene_grids", velocity_text(file, info)}});
    }
    std::string text = printable(file.string()) + ": " + info.format + ", " + count_text(info.grids.size(), "grid") +
                       (info.file_version ? formatted(", file version %u", info.file_version) : "") + ", written by " +
                       info.format + " " + printable(info.library_version, 40) + ", " +
                       printable(info.compression, 60) + "\n";
    text += metadata_lines(info.metadata, "  ");
    for (const VdbGridInfo& grid : info.grids) text += grid_text(grid);
    if (const std::string medium = medium_text(file, info); !medium.empty())
        text += "  in a scene file:\n    \"media\": [" + printable(medium, 1000) + "]\n";
    if (const std::string grids = velocity_text(file, info); !grids.empty())
        text += "  in a scene file, in the medium that it moves:\n    \"grids\": " + printable(grids, 1000) + "\n";
    return text;
}
}
