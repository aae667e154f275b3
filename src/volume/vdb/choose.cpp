#include "volume/vdb/choose.h"

#include "base/error.h"
#include "base/text.h"
#include "volume/vdb/roles.h"

#include <algorithm>

namespace tyndall {
namespace {
// The grids with a given name, in file order.
std::vector<const VdbGridEntry*> grids_named(const VdbDirectory& directory, std::string_view name) {
    std::vector<const VdbGridEntry*> found;
    for (const VdbGridEntry& grid : directory.grids)
        if (grid.name == name) found.push_back(&grid);
    return found;
}

// The grid by exact name, or else by name[index].
const VdbGridEntry* grid_called(const VdbDirectory& directory, std::string_view wanted) {
    if (const auto exact = grids_named(directory, wanted); !exact.empty()) return exact.front();
    const size_t open = wanted.rfind('[');
    if (open == std::string_view::npos || !wanted.ends_with(']')) return nullptr;
    const auto index = parsed<size_t>(wanted.substr(open + 1, wanted.size() - open - 2));
    const auto found = grids_named(directory, wanted.substr(0, open));
    return index && *index < found.size() ? found[*index] : nullptr;
}

}

std::string label(const ByteCursor& file, const VdbGridEntry& grid) {
    return file.where + ": grid \"" + printable(grid.name, 80) + "\"";
}

std::string grid_problem(const VdbGridEntry& grid, float width, std::string_view quantity) {
    if (!is_scalar_float(grid) && (grid.type == "float" || grid.type == "double"))
        return "has the tree shape " + printable(grid.tree_shape, 40) + "; only 5_4_3 is supported";
    if (!is_scalar_float(grid))
        return "holds " + printable(grid.type, 40) + " values, not a " + std::string(quantity) + " per voxel";
    if (grid.grid_class == "level set" && quantity != "density")
        return "is a level set, which holds distances, not a " + std::string(quantity) + " per voxel";
    if (grid.grid_class == "level set" && width == 0)
        return "is a level set; for fog, set a \"width\" in \"grids\": {\"density\": {...}}, no wider than its "
               "narrow band, or convert it (vdb_tool -read in.vdb -ls2fog -write fog.vdb)";
    if (grid.grid_class == "fog volume" && width > 0) return "is a fog volume; a \"width\" is for level sets";
    return grid.transform_problem;
}

std::string key_of(const VdbDirectory& directory, const VdbGridEntry& grid) {
    const auto alike = grids_named(directory, grid.name);
    if (alike.size() == 1 && !grid.name.empty()) return grid.name;
    return grid.name + "[" + std::to_string(std::ranges::find(alike, &grid) - alike.begin()) + "]";
}

const VdbGridEntry* default_grid(const VdbDirectory& directory) {
    std::vector<const VdbGridEntry*> usable, fog;
    for (const VdbGridEntry& grid : directory.grids) {
        if (!grid_problem(grid).empty()) continue;
        if (grid.name == "density") return &grid;
        if (role_of_name(grid.name) != GridRole::density) continue;
        usable.push_back(&grid);
        if (grid.grid_class == "fog volume") fog.push_back(&grid);
    }
    if (!grids_named(directory, "density").empty()) return nullptr;
    if (usable.size() == 1) return usable.front();
    return fog.size() == 1 ? fog.front() : nullptr;
}

namespace {
// The grids of the file with their types; `of_fog`: only those that can be used as fog.
std::string listing(const VdbDirectory& directory, bool of_fog = false) {
    std::vector<std::string> names;
    for (const VdbGridEntry& grid : directory.grids) {
        if (of_fog && !grid_problem(grid).empty()) continue;
        const bool level_set = grid.grid_class == "level set";
        names.push_back(printable(key_of(directory, grid), 40) + " (" + printable(grid.type, 24) +
                        (level_set ? ", level set)" : ")"));
    }
    return joined(names, ", ");
}

[[noreturn]] void refuse_without_fog(const VdbDirectory& directory, const ByteCursor& file) {
    const auto named = grids_named(directory, "density");
    const bool one = directory.grids.size() == 1;
    const bool any = std::ranges::any_of(directory.grids, [](const auto& grid) { return grid_problem(grid).empty(); });
    const VdbGridEntry& first = named.empty() ? directory.grids.front() : *named.front();
    if (any && one) refuse(label(file, first), "is not named as a density; to use it as fog, set \"grid\" to its name");
    const std::string others = "; set \"grid\" to one of " + listing(directory, true);
    if (one || !named.empty()) refuse(label(file, first), grid_problem(first) + (any ? others : ""));
    refuse(file.where, any ? "cannot tell which grid is the density" + others
                           : "none of its grids can be used as fog: " + listing(directory));
}

const VdbGridEntry& existing_grid(const VdbDirectory& directory, const std::string& wanted, const ByteCursor& file) {
    const VdbGridEntry* grid = grid_called(directory, wanted);
    if (!grid) refuse(file.where, "has no grid \"" + printable(wanted, 60) + "\"; it has " + listing(directory));
    return *grid;
}
}

const VdbGridEntry& choose_grid(const VdbDirectory& directory, const std::string& wanted, float width,
                                const ByteCursor& file, std::string_view quantity) {
    if (wanted.empty()) {
        if (const VdbGridEntry* fog = default_grid(directory)) return *fog;
        const bool one = width > 0 && directory.grids.size() == 1 && grid_problem(directory.grids[0], width).empty();
        if (one) return directory.grids.front();
        refuse_without_fog(directory, file);
    }
    const VdbGridEntry& grid = existing_grid(directory, wanted, file);
    if (const std::string why = grid_problem(grid, width, quantity); !why.empty()) refuse(label(file, grid), why);
    return grid;
}

namespace {
// The three names that the name of a color or velocity stands for, where no grid has that name; else the names as
// given.
std::vector<std::string> component_names(const VdbDirectory& directory, std::span<const std::string> names) {
    const std::vector<std::string> given(names.begin(), names.end());
    if (given.size() != 1 || grid_called(directory, given[0]) || !grid_called(directory, given[0] + ".x")) return given;
    return {given[0] + ".x", given[0] + ".y", given[0] + ".z"};
}
}

bool has_grids_called(const VdbDirectory& directory, std::span<const std::string> names) {
    return std::ranges::all_of(component_names(directory, names),
                               [&](const std::string& name) { return grid_called(directory, name) != nullptr; });
}

std::vector<const VdbGridEntry*> color_grids(const VdbDirectory& directory, std::span<const std::string> names,
                                             const ByteCursor& file, std::string_view quantity) {
    const std::vector<std::string> wanted = component_names(directory, names);
    std::vector<const VdbGridEntry*> grids;
    for (const std::string& name : wanted) {
        const VdbGridEntry& grid = existing_grid(directory, name, file);
        const bool vectors = is_vector_float(grid) && wanted.size() == 1;
        if (!vectors && !is_scalar_float(grid))
            refuse(label(file, grid),
                   "holds " + printable(grid.type, 40) + " values, not a " + std::string(quantity) + " per voxel");
        if (!grid.transform_problem.empty()) refuse(label(file, grid), grid.transform_problem);
        grids.push_back(&grid);
    }
    return grids;
}
}
