// tyndall info: OpenVDB files.
#include "common.h"
#include "info.h"
#include "measure/report/grid_report.h"

#include "base/error.h"

namespace tyndall {
namespace {
Json grid_json(const VdbGridInfo& grid) {
    const ivec3 across = voxels_across(grid);
    std::vector<Json> matrix;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) matrix.push_back(json_of(grid.index_to_world[column][row]));
    return json_object({{"name", json_of(std::string_view(grid.name))},
                        {"type", json_of(std::string_view(grid.type))},
                        {"class", json_of(std::string_view(grid.grid_class))},
                        {"usable", json_of(grid.usable)},
                        {"why_not", json_of(std::string_view(grid.why_not))},
                        {"voxels", json_array({json_of(across.x), json_of(across.y), json_of(across.z)})},
                        {"voxel_size", json_of(grid.voxel_size)},
                        {"bounds", json_of(world_bounds(grid))},
                        {"index_to_world", json_array(std::move(matrix))},
                        {"active_voxels", json_of(grid.active_voxels)},
                        {"leaves", json_of(grid.leaves)},
                        {"tiles", json_of(grid.tiles)},
                        {"minimum", json_of(double{grid.minimum})},
                        {"maximum", json_of(double{grid.maximum})},
                        {"mean", json_of(double{grid.mean})},
                        {"background", json_of(double{grid.background})},
                        {"non_finite", json_of(grid.non_finite)},
                        {"negative", json_of(grid.negative)},
                        {"memory_bytes", json_of(grid.memory_bytes)},
                        {"metadata", json_of(grid.metadata)}});
}

std::string metadata_lines(const std::vector<std::pair<std::string, std::string>>& metadata, const char* indent) {
    std::string text;
    for (const auto& [name, value] : metadata)
        text += formatted("%s%s = %s\n", indent, printable(name, 80).c_str(), printable(value, 200).c_str());
    return text;
}

std::string grid_text(const VdbGridInfo& grid) {
    std::string text = "  " + printable(grid.name, 80) + ": " + kind_text(grid) + "\n";
    for (const auto& [name, value] : grid_rows(grid)) text += formatted("    %-13s %s\n", name.c_str(), value.c_str());

    // What stands above already, in other words, is left out.
    std::vector<std::pair<std::string, std::string>> more;
    for (const auto& entry : grid.metadata)
        if (!entry.first.starts_with("file_") && entry.first != "name" && entry.first != "class") more.push_back(entry);
    return text + metadata_lines(more, "    ");
}
}

std::string vdb_report(const std::filesystem::path& file, bool json) {
    const VdbInfo info = vdb_info(file);
    if (json) {
        std::vector<Json> grids;
        for (const VdbGridInfo& grid : info.grids) grids.push_back(grid_json(grid));
        return format_json(json_object({{"file", json_of(std::string_view(file.native()))},
                                        {"kind", json_of("vdb")},
                                        {"file_version", json_of(static_cast<int>(info.file_version))},
                                        {"library_version", json_of(std::string_view(info.library_version))},
                                        {"compression", json_of(std::string_view(info.compression))},
                                        {"metadata", json_of(info.metadata)},
                                        {"grids", json_array(std::move(grids))}})) +
               "\n";
    }
    std::string text = printable(file.string()) + ": OpenVDB, " + count_text(info.grids.size(), "grid") +
                       formatted(", file version %u, written by OpenVDB ", info.file_version) +
                       printable(info.library_version, 40) + ", " + printable(info.compression, 60) + "\n";
    text += metadata_lines(info.metadata, "  ");
    for (const VdbGridInfo& grid : info.grids) text += grid_text(grid);
    return text;
}
}
