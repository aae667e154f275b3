// tyndall info: OpenVDB files.
#include "common.h"
#include "info.h"

#include "base/error.h"
#include "volume/vdb.h"

namespace tyndall {
namespace {
ivec3 voxels_across(const VdbGridInfo& grid) { return glm::max(grid.active_high - grid.active_low + 1, ivec3(0)); }

// World box of the active voxels, their whole cells included.
Box world_bounds(const VdbGridInfo& grid) {
    const ivec3 across = voxels_across(grid);
    if (across.x == 0 || across.y == 0 || across.z == 0) return {};
    return transform(mat4(grid.index_to_world), Box{vec3(grid.active_low) - 0.5f, vec3(grid.active_high) + 0.5f});
}

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

// The linear part of a transform when it is more than a scale along the axes.
std::string transform_line(const VdbGridInfo& grid) {
    const dmat4& m = grid.index_to_world;
    const bool along_axes =
        m[0][1] == 0 && m[0][2] == 0 && m[1][0] == 0 && m[1][2] == 0 && m[2][0] == 0 && m[2][1] == 0;
    if (along_axes && m[0][0] > 0 && m[1][1] > 0 && m[2][2] > 0) return "";
    return "    axes          x " + vector_text(vec3(m[0])) + "   y " + vector_text(vec3(m[1])) + "   z " +
           vector_text(vec3(m[2])) + "\n";
}

// What was found among the values; only grids of densities are looked through.
std::string value_lines(const VdbGridInfo& grid) {
    const ivec3 across = voxels_across(grid);
    const Box bounds = world_bounds(grid);
    std::string text = formatted("    extent        %d x %d x %d voxels of %s m\n", across.x, across.y, across.z,
                                 vector_text(grid.voxel_size).c_str());
    text += bounds.empty()
                ? "    world         empty\n"
                : "    world         " + vector_text(bounds.low) + " to " + vector_text(bounds.high) + " m\n";
    text += transform_line(grid);
    text += formatted("    values        %g to %g, mean %g, background %g\n", static_cast<double>(grid.minimum),
                      static_cast<double>(grid.maximum), static_cast<double>(grid.mean),
                      static_cast<double>(grid.background));
    if (grid.non_finite || grid.negative)
        text += "    faults        " + std::to_string(grid.non_finite) + " not finite, " +
                std::to_string(grid.negative) + " negative: read as 0\n";
    return text;
}

std::string grid_text(const VdbGridInfo& grid) {
    std::string text = "  " + printable(grid.name, 80) + ": " + printable(grid.type, 80) + ", " +
                       (grid.grid_class.empty() ? "no class" : printable(grid.grid_class, 40)) + ", " +
                       (grid.usable ? "usable as fog" : "not usable as fog: " + printable(grid.why_not)) + "\n";
    text += "    active        " + count_text(grid.active_voxels, "voxel") + " in " + std::to_string(grid.leaves) +
            " leaves and " + count_text(grid.tiles, "tile") + ", " +
            bytes_text(static_cast<double>(grid.memory_bytes)) + "\n";
    if (grid.usable || !world_bounds(grid).empty()) text += value_lines(grid);

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
