#include "volume/vdb/vdb.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"
#include "volume/vdb/codec.h"
#include "volume/vdb/fog.h"
#include "volume/vdb/head.h"
#include "volume/vdb/prewalk.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cctype>
#include <fstream>
#include <limits>
#include <new>

namespace tyndall {
namespace {
std::string label(const ByteCursor& file, const VdbGridEntry& grid) {
    return file.where + ": grid \"" + printable(grid.name, 80) + "\"";
}

// Why a grid cannot be fog; empty when it can.
std::string obstacle(const VdbGridEntry& grid) {
    if (!is_scalar_float(grid) && (grid.type == "float" || grid.type == "double"))
        return "has the tree shape " + printable(grid.tree_shape, 40) + ", only 5_4_3 can be read";
    if (!is_scalar_float(grid)) return "holds " + printable(grid.type, 40) + " values, not a density per voxel";
    if (grid.grid_class == "level set")
        return "is a level set; convert it to fog first (vdb_tool -read in.vdb -ls2fog -write fog.vdb)";
    return grid.transform_problem;
}

// The grids of a name in file order.
std::vector<const VdbGridEntry*> grids_named(const VdbDirectory& directory, std::string_view name) {
    std::vector<const VdbGridEntry*> found;
    for (const VdbGridEntry& grid : directory.grids)
        if (grid.name == name) found.push_back(&grid);
    return found;
}

// What grid_called finds it by: its name, with an index where several have the name or it has none.
std::string key_of(const VdbDirectory& directory, const VdbGridEntry& grid) {
    const auto alike = grids_named(directory, grid.name);
    if (alike.size() == 1 && !grid.name.empty()) return grid.name;
    return grid.name + "[" + std::to_string(std::ranges::find(alike, &grid) - alike.begin()) + "]";
}

std::string listing(const VdbDirectory& directory) {
    std::vector<std::string> names;
    for (const VdbGridEntry& grid : directory.grids) {
        const bool level_set = grid.grid_class == "level set";
        names.push_back(printable(key_of(directory, grid), 40) + " (" + printable(grid.type, 24) +
                        (level_set ? ", level set)" : ")"));
    }
    return joined(names, ", ");
}

// A name, or name[index] when no grid is called so to the letter.
const VdbGridEntry* grid_called(const VdbDirectory& directory, std::string_view wanted) {
    if (const auto exact = grids_named(directory, wanted); !exact.empty()) return exact.front();
    const size_t open = wanted.rfind('[');
    if (open == std::string_view::npos || !wanted.ends_with(']')) return nullptr;
    const auto index = parsed<size_t>(wanted.substr(open + 1, wanted.size() - open - 2));
    const auto found = grids_named(directory, wanted.substr(0, open));
    return index && *index < found.size() ? found[*index] : nullptr;
}

// Names by which programs write quantities other than a density.
bool names_another_quantity(std::string_view name) {
    constexpr std::string_view others[] = {"temperature", "temp",  "heat", "flame",    "flames",  "fire", "fuel",
                                           "burn",        "color", "cd",   "emission", "shadow",  "vel",  "velocity",
                                           "pressure",    "v",     "rest", "uvw",      "surface", "sdf"};
    std::string lower(name);
    for (char& letter : lower) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return std::ranges::count(others, std::string_view(lower).substr(0, lower.find('.'))) > 0;
}

// What is taken when no grid is named: the first density; else the only one that can be fog and is not called something
// else, or is alone of class fog volume; null when there is none such.
const VdbGridEntry* fog_of(const VdbDirectory& directory) {
    std::vector<const VdbGridEntry*> usable, fog;
    for (const VdbGridEntry& grid : directory.grids) {
        if (!obstacle(grid).empty()) continue;
        if (grid.name == "density") return &grid;
        if (names_another_quantity(grid.name)) continue;
        usable.push_back(&grid);
        if (grid.grid_class == "fog volume") fog.push_back(&grid);
    }
    if (!grids_named(directory, "density").empty()) return nullptr;
    if (usable.size() == 1) return usable.front();
    return fog.size() == 1 ? fog.front() : nullptr;
}

[[noreturn]] void refuse_without_fog(const VdbDirectory& directory, const ByteCursor& file) {
    const auto named = grids_named(directory, "density");
    const bool one = directory.grids.size() == 1;
    const bool any = std::ranges::any_of(directory.grids, [](const auto& grid) { return obstacle(grid).empty(); });
    const VdbGridEntry& first = named.empty() ? directory.grids.front() : *named.front();
    if (any && one) refuse(label(file, first), "is not called a density; if it is the fog, name it as \"grid\"");
    const std::string others = "; \"grid\" takes one of " + listing(directory);
    if (one || !named.empty()) refuse(label(file, first), obstacle(first) + (any ? others : ""));
    refuse(file.where, any ? "it is not clear which grid is the fog" + others
                           : "none of its grids can be fog: " + listing(directory));
}

const VdbGridEntry& choose_grid(const VdbDirectory& directory, const std::string& wanted, const ByteCursor& file) {
    if (wanted.empty()) {
        if (const VdbGridEntry* fog = fog_of(directory)) return *fog;
        refuse_without_fog(directory, file);
    }
    const VdbGridEntry* grid = grid_called(directory, wanted);
    if (!grid) refuse(file.where, "has no grid \"" + printable(wanted, 60) + "\", it holds " + listing(directory));
    if (const std::string why = obstacle(*grid); !why.empty()) refuse(label(file, *grid), why);
    return *grid;
}

// Most memory this process may hope for: of the machine, its control group and its own limit.
uint64_t available_memory() {
    uint64_t most = static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        most = std::min<uint64_t>(most, limit.rlim_cur);
    uint64_t group = 0;
    if (std::ifstream("/sys/fs/cgroup/memory.max") >> group) most = std::min(most, group);
    return most - most / 8;
}

// Of the library's tree, whose leaves hold no values, and of ours, which stand side by side for a moment.
uint64_t memory_needed(const VdbTreeCounts& counts) {
    const uint64_t leaf = 128 + sizeof(Leaf) + sizeof(VoxelMask) + sizeof(uint64_t);
    return counts.leaves * leaf + counts.lower_nodes * (4096 * 8 + 1100) + counts.upper_nodes * (32768 * 8 + 8300) +
           counts.root_tiles * 160 + counts.active_tiles * sizeof(Tile);
}

void check_memory(uint64_t bytes, const std::string& where) {
    const uint64_t available = available_memory();
    if (bytes <= available) return;
    fail(ExitCode::out_of_memory, where,
         "needs " + std::to_string(bytes >> 20) + " MB of memory, there are " + std::to_string(available >> 20) +
             " MB");
}

// Reads the bytes of a tree once, walks them, and decodes the very bytes that were walked.
DecodedTree load_tree(ByteCursor& file, const VdbDirectory& directory, const VdbGridEntry& grid,
                      VdbTreeCounts& counts) {
    const std::string where = label(file, grid);
    const uint64_t size = grid.tree_end - grid.tree_begin;
    check_memory(size, where);
    file.seek(grid.tree_begin, "the grid");
    const LargeBytes memory = large_bytes(size);
    file.read(memory.get(), size, "the grid");

    const std::string_view bytes(memory.get(), size);
    ByteCursor tree(where, bytes, grid.tree_begin);
    counts = walk_tree(tree, grid);
    if (tree.left() > 0) tree.complain("its voxels end before the grid does");
    check_memory(size + memory_needed(counts), where);
    return decode_tree(bytes, grid, counts, directory.file_version, where);
}

// An allocation that fails is the user's to know, not a crash.
template<class Body> auto within_memory(const std::filesystem::path& path, const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        fail(ExitCode::out_of_memory, path.string(), "does not fit into memory");
    }
}

VdbGridInfo grid_info(ByteCursor& file, const VdbDirectory& directory, const VdbGridEntry& grid) {
    VdbGridInfo info;
    info.name = grid.name, info.type = grid.type, info.grid_class = grid.grid_class;
    info.key = key_of(directory, grid);
    info.why_not = obstacle(grid), info.usable = info.why_not.empty(), info.is_fog = fog_of(directory) == &grid;
    info.index_to_world = grid.index_to_world;
    for (int axis = 0; axis < 3; ++axis)
        info.voxel_size[axis] = static_cast<float>(glm::length(dvec3(grid.index_to_world[axis])));
    info.metadata = grid.metadata;
    if (!is_walkable(grid)) return info;

    VdbTreeCounts counts;
    if (is_scalar_float(grid)) {
        const DecodedTree tree = load_tree(file, directory, grid, counts);
        const ActiveBox box = active_box(tree);
        info.active_low = box.low, info.active_high = box.high;
        add_statistics(tree, info);
    } else {
        const std::string where = std::exchange(file.where, label(file, grid));
        file.seek(grid.tree_begin, "the grid");
        counts = walk_tree(file, grid);
        file.where = where;
    }
    info.active_voxels = counts.active_voxels, info.leaves = counts.leaves, info.tiles = counts.active_tiles;
    info.memory_bytes = memory_needed(counts);
    return info;
}

SparseVolume read_fog(const std::filesystem::path& path, const std::string& wanted, VdbReadReport* report) {
    ByteCursor file(path);
    VdbDirectory directory = read_directory(file);
    const VdbGridEntry& grid = choose_grid(directory, wanted, file);

    SparseVolume volume;
    VdbReadReport mended;
    VdbTreeCounts counts;
    volume.name = mended.grid = grid.name;
    volume.index_to_world = grid.index_to_world;
    make_fog(load_tree(file, directory, grid, counts), volume, mended, label(file, grid));
    volume.metadata = std::move(directory.metadata);
    if (report) *report = mended;
    return volume;
}

VdbInfo file_info(const std::filesystem::path& path) {
    ByteCursor file(path);
    const VdbDirectory directory = read_directory(file);
    VdbInfo info;
    info.file_version = directory.file_version;
    info.library_version = std::to_string(directory.library_major) + "." + std::to_string(directory.library_minor);
    info.compression = compression_name(directory.grids.front().compression);
    info.metadata = directory.metadata;
    for (const VdbGridEntry& grid : directory.grids) info.grids.push_back(grid_info(file, directory, grid));
    return info;
}
}

SparseVolume read_vdb(const std::filesystem::path& path, const std::string& wanted, VdbReadReport* report) {
    return within_memory(path, [&] { return read_fog(path, wanted, report); });
}

VdbInfo vdb_info(const std::filesystem::path& path) {
    return within_memory(path, [&] { return file_info(path); });
}

VdbMetadata vdb_metadata(const std::filesystem::path& path) {
    ByteCursor file(path);
    return read_directory(file).metadata;
}

bool is_as_written(const std::filesystem::path& path) {
    return has_identity_of_content(read_file(path, std::numeric_limits<uint64_t>::max()));
}

VdbImage::VdbImage(const VdbContent& content, const VdbWriteOptions& options, const std::string& where)
    : fog_(std::make_unique<EncodedFog>(encode_fog(content, options, where))) {}
VdbImage::VdbImage(VdbImage&&) noexcept = default;
VdbImage::~VdbImage() = default;

void VdbImage::write(const std::filesystem::path& file) const { write_file_atomically(file, fog_->pieces()); }
uint64_t VdbImage::voxels() const { return fog_->voxels(); }

void write_vdb(const std::filesystem::path& path, const SparseVolume& volume, const VdbWriteOptions& options) {
    VdbContent content{volume.name, volume.index_to_world, volume.metadata, volume.tiles, {}, {}};
    content.origins.reserve(volume.leaves.size());
    for (const Leaf& leaf : volume.leaves) content.origins.push_back(leaf.origin);
    content.fill = [&](size_t number, Leaf& leaf) { leaf = volume.leaves[number]; };
    VdbImage(content, options, path.string()).write(path);
}

std::string VdbReadReport::summary() const {
    std::vector<std::string> parts;
    if (empty) parts.push_back("is empty");
    if (non_finite) parts.push_back(std::to_string(non_finite) + " voxels that are not finite set to 0");
    if (negative) parts.push_back(std::to_string(negative) + " negative voxels set to 0");
    if (background != 0)
        parts.push_back(formatted("background %g dropped outside the active voxels", static_cast<double>(background)));
    return parts.empty() ? "" : "grid \"" + printable(grid, 80) + "\": " + joined(parts, ", ");
}
}
