#include "volume/vdb/vdb.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"
#include "volume/vdb/choose.h"
#include "volume/vdb/file/head.h"
#include "volume/vdb/fog.h"
#include "volume/vdb/load.h"
#include "volume/vdb/mask_union.h"

#include <glm/gtc/matrix_transform.hpp>

#include <limits>

namespace tyndall {
namespace {
// Distances are known only within the narrow band, whose half width is the background value. Where that is not above 0,
// as programs write that keep every distance, they are known down to the least one.
void check_width(const ValueMap& map, const DecodedTree& tree, const std::string& where) {
    VdbGridInfo known;
    if (!(tree.background > 0)) add_statistics(tree, known);
    const float depth = tree.background > 0 ? tree.background : std::max(-known.minimum, 0.0f);
    if (!(map.width > depth)) return;
    refuse(where,
           formatted(tree.background > 0
                         ? "its narrow band has a half width of %g, in the file's units; a \"width\" of %g exceeds it"
                         : "its distances reach down to %g below 0, in the file's units; a \"width\" of %g exceeds it",
                     static_cast<double>(depth), static_cast<double>(map.width)));
}

SparseVolume read_fog(const std::filesystem::path& path, const std::string& wanted, const ValueMap& map, float most,
                      VdbReadReport* report, std::string_view quantity) {
    ByteCursor file(path);
    VdbDirectory directory = read_grids(file);
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

// The three grids of a color, which share one voxel grid; or the only one.
std::vector<const VdbGridEntry*> aligned_color_grids(const VdbDirectory& directory, std::span<const std::string> names,
                                                     const ByteCursor& file) {
    const std::vector<const VdbGridEntry*> grids = color_grids(directory, names, file, "color");
    for (const VdbGridEntry* grid : grids)
        if (grid->index_to_world != grids[0]->index_to_world)
            refuse(file.where, "the three grids of a color have different transforms");
    return grids;
}

ColorVolume read_color(const std::filesystem::path& path, std::span<const std::string> names, const ValueMap& map,
                       float most, VdbReadReport* report) {
    ByteCursor file(path);
    const VdbDirectory directory = read_grids(file);
    const std::vector<const VdbGridEntry*> grids = aligned_color_grids(directory, names, file);
    const int channels = is_vector_float(*grids[0]) ? 3 : static_cast<int>(grids.size());
    ColorVolume color;
    DecodedTree coverage;
    VdbReadReport mended, nothing;
    bool empty = true;
    mended.grid = names.size() == 1 ? names[0] : grids[0]->name;
    for (int c = 0; c < channels; ++c) {
        const VdbGridEntry& grid = *grids[grids.size() == 1 ? 0 : static_cast<size_t>(c)];
        VdbTreeCounts counts;
        DecodedTree tree = load_tree(file, directory, grid, counts, is_vector_float(grid) ? c : 0);
        apply(map, tree);
        keep_active(tree);
        if (most < infinity) limit(tree, most, mended);
        if (c == 0)
            coverage = active_mask(tree);
        else
            unite(coverage, tree);
        color.channels.push_back(cleaned_volume(std::move(tree), grid, file, mended));
        empty &= mended.empty;
    }
    color.coverage = cleaned_volume(std::move(coverage), *grids[0], file, nothing);
    mended.empty = empty;
    if (report) *report = mended;
    return color;
}

SparseVolume plain_volume(DecodedTree tree, const VdbGridEntry& grid) {
    SparseVolume volume;
    volume.name = grid.name, volume.index_to_world = grid.index_to_world;
    make_plain(std::move(tree), volume);
    return volume;
}

// Where any component of a velocity in three grids is known, if that differs between them; empty if it does not, or if
// their voxels lie apart.
SparseVolume united_voxels(std::span<const DecodedTree> masks, std::span<const VdbGridEntry* const> grids) {
    DecodedTree all;
    const VdbGridEntry* place = nullptr;
    bool differ = false;
    for (size_t c = 0; c < masks.size(); ++c) {
        if (active_box(masks[c]).empty()) continue;
        if (place && place->index_to_world != grids[c]->index_to_world) return {};
        if (!place) place = grids[c], all = masks[c];
        differ |= !same_voxels(all, masks[c]);
        unite(all, masks[c]);
    }
    return differ ? plain_volume(std::move(all), *place) : SparseVolume();
}

// A staggered grid stores each component on the lower voxel face along that axis.
VelocityVolume read_velocity(const std::filesystem::path& path, std::span<const std::string> names, const ValueMap& map,
                             VdbReadReport* report) {
    ByteCursor file(path);
    const VdbDirectory directory = read_grids(file);
    const std::vector<const VdbGridEntry*> grids = color_grids(directory, names, file, "velocity");
    const bool vectors = is_vector_float(*grids[0]);
    if (!vectors && grids.size() == 1)
        refuse(label(file, *grids[0]), "has one number per voxel; velocity needs a vector grid or three scalar grids");
    VelocityVolume velocity;
    std::vector<DecodedTree> masks;
    VdbReadReport mended;
    mended.grid = names.size() == 1 ? names[0] : grids[0]->name, mended.empty = true;
    for (int c = 0; c < 3; ++c) {
        const VdbGridEntry& grid = *grids[vectors ? 0 : static_cast<size_t>(c)];
        VdbTreeCounts counts;
        DecodedTree tree = load_tree(file, directory, grid, counts, vectors ? c : 0);
        keep_finite(tree, mended);
        apply(map, tree);
        if (c == 0 || !vectors) masks.push_back(active_mask(tree));
        SparseVolume& component = velocity.components[static_cast<size_t>(c)];
        component = plain_volume(std::move(tree), grid);
        mended.empty &= component.empty();
        if (vectors && grid.grid_class == "staggered") {
            dvec3 face(0);
            face[c] = -0.5;
            component.index_to_world = glm::translate(component.index_to_world, face);
        }
    }
    velocity.any = united_voxels(masks, grids);
    for (size_t c = 0; c < masks.size(); ++c) velocity.known.push_back(plain_volume(std::move(masks[c]), *grids[c]));
    if (report) *report = mended;
    return velocity;
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

Box stated_bounds(const std::filesystem::path& path, const std::string& wanted, const ValueMap& map) {
    ByteCursor file(path);
    const VdbDirectory directory = read_grids(file);
    const VdbGridEntry& grid = choose_grid(directory, wanted, map.width, file, "density");
    const Box voxels{vec3(grid.stated_low) - 0.5f, vec3(grid.stated_high) + 0.5f};
    Box bounds;
    for (int i = 0; i < 8 && glm::all(glm::lessThanEqual(grid.stated_low, grid.stated_high)); ++i)
        bounds.grow(vec3(grid.index_to_world * glm::dvec4(voxels.corner(i), 1)));
    return bounds;
}

VdbMetadata vdb_metadata(const std::filesystem::path& path) {
    ByteCursor file(path);
    return read_directory(file).metadata;
}

GridsFound find_vdb_grids(const std::filesystem::path& path, std::span<const std::string> names) {
    ByteCursor file(path);
    const VdbDirectory directory = read_directory(file);
    if (directory.grids.empty()) return GridsFound::empty_file;
    return has_grids_called(directory, names) ? GridsFound::all : GridsFound::not_all;
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
