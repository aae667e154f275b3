#include "volume/vdb/vdb.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"
#include "volume/bricks/bricks.h"
#include "volume/vdb/choose.h"
#include "volume/vdb/codec.h"
#include "volume/vdb/fog.h"
#include "volume/vdb/head.h"
#include "volume/vdb/memory.h"
#include "volume/vdb/nano/file.h"
#include "volume/vdb/nano/tree.h"
#include "volume/vdb/prewalk.h"

#include <glm/gtc/matrix_transform.hpp>

#include <limits>
#include <new>

namespace tyndall {
namespace {
DecodedTree load_nano_tree(ByteCursor& file, const VdbGridEntry& grid, VdbTreeCounts& counts, int component) {
    const std::string where = label(file, grid);
    check_memory(grid.nano_bytes, where);
    const LargeBytes memory = unpacked_grid(file, grid);
    return decode_nano_tree({memory.get(), grid.nano_bytes}, grid, counts, where, component);
}

// Reads the bytes of a tree once, and validates and decodes the same bytes in memory.
DecodedTree load_tree(ByteCursor& file, const VdbDirectory& directory, const VdbGridEntry& grid, VdbTreeCounts& counts,
                      int component = 0) {
    if (directory.nano) return load_nano_tree(file, grid, counts = {}, component);
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
    return decode_tree(bytes, grid, counts, directory.file_version, where, component);
}

// Reports a failed allocation as an Error.
template<class Body> auto within_memory(const std::filesystem::path& path, const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        fail(ExitCode::out_of_memory, path.string(), "does not fit into memory");
    }
}

// A cleaned volume from one tree; adds its corrections to the report.
SparseVolume cleaned_volume(DecodedTree tree, const VdbGridEntry& grid, const ByteCursor& file, VdbReadReport& report) {
    SparseVolume volume;
    VdbReadReport own;
    volume.name = grid.name, volume.index_to_world = grid.index_to_world;
    make_fog(std::move(tree), volume, own, label(file, grid));
    report.non_finite += own.non_finite, report.negative += own.negative;
    report.background = own.background, report.empty = own.empty;
    return volume;
}

// Marks a grid that spans too many voxels as not usable.
void check_size(DecodedTree tree, const VdbGridEntry& grid, const ByteCursor& file, VdbGridInfo& info) {
    VdbReadReport unused;
    info.why_not = bricks_problem(cleaned_volume(std::move(tree), grid, file, unused));
    info.usable = info.why_not.empty(), info.is_fog &= info.usable;
}

VdbGridInfo grid_info(ByteCursor& file, const VdbDirectory& directory, const VdbGridEntry& grid) {
    VdbGridInfo info;
    info.name = grid.name, info.type = grid.type, info.grid_class = grid.grid_class;
    info.key = key_of(directory, grid), info.role = role_of(grid);
    info.why_not = grid_problem(grid), info.usable = info.why_not.empty(),
    info.is_fog = default_grid(directory) == &grid;
    info.index_to_world = grid.index_to_world;
    for (int axis = 0; axis < 3; ++axis)
        info.voxel_size[axis] = static_cast<float>(glm::length(dvec3(grid.index_to_world[axis])));
    info.metadata = grid.metadata;
    if (!is_walkable(grid)) return info;

    VdbTreeCounts counts;
    const bool numbers = is_scalar_float(grid), vectors = is_vector_float(grid);
    if (numbers || vectors) {
        for (int component = vectors ? 2 : 0; component >= 0; --component) {
            DecodedTree tree = load_tree(file, directory, grid, counts, component);
            const ActiveBox box = active_box(tree);
            info.active_low = box.low, info.active_high = box.high;
            add_statistics(tree, info);
            if (vectors) info.ranges.insert(info.ranges.begin(), {info.minimum, info.maximum});
            if (info.usable && tree.background == 0) check_size(std::move(tree), grid, file, info);
        }
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

// Distances are known only within the narrow band, whose half width is the background value.
void check_width(const ValueMap& map, const DecodedTree& tree, const std::string& where) {
    if (!(map.width > tree.background) || !(tree.background > 0)) return;
    refuse(where, formatted("its narrow band has a half width of %g, in the file's units; a \"width\" of %g exceeds it",
                            static_cast<double>(tree.background), static_cast<double>(map.width)));
}

SparseVolume read_fog(const std::filesystem::path& path, const std::string& wanted, const ValueMap& map, float most,
                      VdbReadReport* report, std::string_view quantity) {
    ByteCursor file(path);
    VdbDirectory directory = read_directory(file);
    const VdbGridEntry& grid = choose_grid(directory, wanted, map.width, file, quantity);
    VdbReadReport mended;
    VdbTreeCounts counts;
    mended.grid = grid.name;
    DecodedTree tree = load_tree(file, directory, grid, counts);
    if (map.width > 0) check_width(map, tree, label(file, grid));
    apply(map, tree);
    if (most < infinity) limit(tree, most, mended);
    SparseVolume volume = cleaned_volume(std::move(tree), grid, file, mended);
    volume.metadata = std::move(directory.metadata);
    if (report) *report = mended;
    return volume;
}

ColorVolume read_color(const std::filesystem::path& path, std::span<const std::string> names, const ValueMap& map,
                       float most, VdbReadReport* report) {
    ByteCursor file(path);
    const VdbDirectory directory = read_directory(file);
    const std::vector<const VdbGridEntry*> grids = color_grids(directory, names, file, "color");
    const int channels = is_vector_float(*grids[0]) ? 3 : static_cast<int>(grids.size());
    ColorVolume color;
    VdbReadReport mended;
    mended.grid = names.size() == 1 ? names[0] : grids[0]->name;
    for (int c = 0; c < channels; ++c) {
        const VdbGridEntry& grid = *grids[grids.size() == 1 ? 0 : static_cast<size_t>(c)];
        VdbTreeCounts counts;
        DecodedTree tree = load_tree(file, directory, grid, counts, is_vector_float(grid) ? c : 0);
        apply(map, tree);
        keep_active(tree);
        if (most < infinity) limit(tree, most, mended);
        VdbReadReport nothing;
        if (c == 0) color.coverage = cleaned_volume(active_mask(tree), grid, file, nothing);
        color.channels.push_back(cleaned_volume(std::move(tree), grid, file, mended));
    }
    if (report) *report = mended;
    return color;
}

SparseVolume plain_volume(DecodedTree tree, const VdbGridEntry& grid) {
    SparseVolume volume;
    volume.name = grid.name, volume.index_to_world = grid.index_to_world;
    make_plain(std::move(tree), volume);
    return volume;
}

// A staggered grid stores each component on the lower voxel face along that axis.
VelocityVolume read_velocity(const std::filesystem::path& path, std::span<const std::string> names, const ValueMap& map,
                             VdbReadReport* report) {
    ByteCursor file(path);
    const VdbDirectory directory = read_directory(file);
    const std::vector<const VdbGridEntry*> grids = color_grids(directory, names, file, "velocity");
    const bool vectors = is_vector_float(*grids[0]);
    if (!vectors && grids.size() == 1)
        refuse(label(file, *grids[0]), "has one number per voxel; velocity needs a vector grid or three scalar grids");
    VelocityVolume velocity;
    VdbReadReport mended;
    mended.grid = names.size() == 1 ? names[0] : grids[0]->name, mended.empty = true;
    for (int c = 0; c < 3; ++c) {
        const VdbGridEntry& grid = *grids[vectors ? 0 : static_cast<size_t>(c)];
        VdbTreeCounts counts;
        DecodedTree tree = load_tree(file, directory, grid, counts, vectors ? c : 0);
        keep_finite(tree, mended);
        apply(map, tree);
        if (c == 0 || !vectors) velocity.known.push_back(plain_volume(active_mask(tree), grid));
        SparseVolume& component = velocity.components[static_cast<size_t>(c)];
        component = plain_volume(std::move(tree), grid);
        mended.empty &= component.empty();
        if (vectors && grid.grid_class == "staggered") {
            dvec3 face(0);
            face[c] = -0.5;
            component.index_to_world = glm::translate(component.index_to_world, face);
        }
    }
    if (report) *report = mended;
    return velocity;
}

VdbInfo file_info(const std::filesystem::path& path) {
    ByteCursor file(path);
    const VdbDirectory directory = read_directory(file);
    VdbInfo info;
    info.format = directory.nano ? "NanoVDB" : "OpenVDB", info.file_version = directory.file_version;
    info.library_version = std::to_string(directory.library_major) + "." + std::to_string(directory.library_minor);
    info.compression = compression_name(directory.grids.front().compression);
    info.metadata = directory.metadata;
    for (const VdbGridEntry& grid : directory.grids) info.grids.push_back(grid_info(file, directory, grid));
    return info;
}
}

bool is_volume_name(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    return extension == ".vdb" || extension == ".nvdb";
}

SparseVolume read_vdb(const std::filesystem::path& path, const std::string& wanted, VdbReadReport* report) {
    return read_vdb(path, wanted, ValueMap(), infinity, report);
}

SparseVolume read_vdb(const std::filesystem::path& path, const std::string& wanted, const ValueMap& map, float most,
                      VdbReadReport* report, std::string_view quantity) {
    return within_memory(path, [&] { return read_fog(path, wanted, map, most, report, quantity); });
}

ColorVolume read_color_vdb(const std::filesystem::path& path, std::span<const std::string> grids, const ValueMap& map,
                           float most, VdbReadReport* report) {
    return within_memory(path, [&] { return read_color(path, grids, map, most, report); });
}

VelocityVolume read_velocity_vdb(const std::filesystem::path& path, std::span<const std::string> grids,
                                 const ValueMap& map, VdbReadReport* report) {
    return within_memory(path, [&] { return read_velocity(path, grids, map, report); });
}

VdbInfo vdb_info(const std::filesystem::path& path) {
    return within_memory(path, [&] { return file_info(path); });
}

VdbMetadata vdb_metadata(const std::filesystem::path& path) {
    ByteCursor file(path);
    return read_directory(file).metadata;
}

bool is_as_written(const std::filesystem::path& path) {
    return has_content_uuid(read_file(path, std::numeric_limits<uint64_t>::max()));
}

VdbImage::VdbImage(const VdbContent& content, const VdbWriteOptions& options, const std::string& where)
    : fog_(std::make_unique<EncodedFog>(encode_fog(content, options, where))) {}
VdbImage::VdbImage(VdbImage&&) noexcept = default;
VdbImage::~VdbImage() = default;

void VdbImage::write(const std::filesystem::path& file) const { write_file_atomically(file, fog_->pieces()); }
uint64_t VdbImage::voxels() const { return fog_->voxels(); }

void write_vdb(const std::filesystem::path& path, const SparseVolume& volume, const VdbWriteOptions& options) {
    VdbContent content{{{volume.name}}, volume.index_to_world, volume.metadata, volume.tiles, {}, {}};
    content.origins.reserve(volume.leaves.size());
    for (const Leaf& leaf : volume.leaves) content.origins.push_back(leaf.origin);
    content.fill = [&](size_t number, std::span<Leaf> leaves) { leaves[0] = volume.leaves[number]; };
    VdbImage(content, options, path.string()).write(path);
}

std::string VdbReadReport::summary() const {
    std::vector<std::string> parts;
    if (empty) parts.push_back("is empty");
    if (non_finite) parts.push_back(std::to_string(non_finite) + " non-finite voxels set to 0");
    if (negative) parts.push_back(std::to_string(negative) + " negative voxels set to 0");
    if (above)
        parts.push_back(std::to_string(above) + formatted(" voxels above %g clamped to it", static_cast<double>(most)));
    if (background != 0)
        parts.push_back(formatted("background %g ignored outside the bounding box of the active voxels",
                                  static_cast<double>(background)));
    return parts.empty() ? "" : "grid \"" + printable(grid, 80) + "\": " + joined(parts, ", ");
}
}
