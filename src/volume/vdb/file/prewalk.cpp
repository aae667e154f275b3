#include "volume/vdb/file/prewalk.h"

#include "base/error.h"
#include "base/text.h"
#include "volume/vdb/file/transform.h"
#include "volume/vdb/nano/file.h"

#include <cstring>
#include <sstream>

namespace tyndall {
namespace {
constexpr int64_t magic = 0x56444220;
constexpr uint32_t oldest_version = 222, newest_version = 225; // 225 adds only a grid type that is not read
constexpr uint64_t max_text = 4096, max_items = 4096, max_metadata = 16 << 20, max_grids = 1024;

// Checks the magic number, with a specific hint for Git LFS pointers, a common mistake.
void check_magic(ByteCursor& file) {
    char start[20] = {};
    file.read(start, std::min<uint64_t>(sizeof start, file.left()), "the header");
    const std::string_view text(start, sizeof start);
    if (text.starts_with("version https://git-"))
        refuse(file.where, "is a Git LFS pointer, not a volume: run git lfs pull");
    if (std::memcmp(start, &magic, sizeof magic) != 0) refuse(file.where, "is neither an OpenVDB nor a NanoVDB file");
    file.seek(sizeof magic, "the header");
}

template<class T> void append_number(std::string& text, T value) {
    text += (text.empty() ? "" : " ") + shortest_text(value);
}

// The numbers of a metadata value, separated by spaces.
template<class T> std::string numbers(ByteCursor& file, uint32_t size, size_t count, const std::string& name) {
    if (size != count * sizeof(T))
        file.complain("metadata " + name + " has an invalid size of " + std::to_string(size));
    std::string text;
    for (size_t i = 0; i < count; ++i) append_number(text, file.value<T>("metadata " + name));
    return text;
}

// Number of components of a metadata type: vec3s 3, mat4d 16, float 1.
size_t component_count(const std::string& type) {
    if (type.size() != 5) return 1;
    const size_t n = static_cast<size_t>(type[3] - '0');
    return type.starts_with("vec") ? n : type.starts_with("mat") ? n * n : 1;
}

// Reads one value as text; skips it and returns false if its type is not supported.
bool read_value(ByteCursor& file, const std::string& name, const std::string& type, std::string& text) {
    const auto size = file.value<uint32_t>("metadata " + name);
    const bool vector =
        type.size() == 5 && (type.starts_with("vec") || type.starts_with("mat")) && type[3] >= '2' && type[3] <= '4';
    const size_t count = component_count(type);
    if (type == "string") {
        if (size > max_metadata) file.complain("metadata " + name + " has an invalid size of " + std::to_string(size));
        text = file.bytes(size, "metadata " + name);
    } else if (type == "bool") {
        if (size != 1) file.complain("metadata " + name + " has an invalid size of " + std::to_string(size));
        text = file.value<char>("metadata " + name) ? "true" : "false";
    } else if (type == "float" || (vector && type[4] == 's')) {
        text = numbers<float>(file, size, count, name);
    } else if (type == "double" || (vector && type[4] == 'd')) {
        text = numbers<double>(file, size, count, name);
    } else if (type == "int32" || (vector && type[4] == 'i')) {
        text = numbers<int32_t>(file, size, count, name);
    } else if (type == "int64") {
        text = numbers<int64_t>(file, size, 1, name);
    } else {
        file.skip(size, "metadata " + name);
        return false;
    }
    return true;
}

VdbMetadata read_metadata(ByteCursor& file) {
    const auto count = file.value<uint32_t>("the number of metadata entries");
    if (count > max_items) file.complain("claims " + std::to_string(count) + " metadata entries");
    VdbMetadata metadata;
    const uint64_t start = file.position();
    for (uint32_t i = 0; i < count; ++i) {
        std::string name = file.text(max_text, "a metadata name"), value;
        const std::string type = file.text(max_text, "the type of metadata " + name);
        if (read_value(file, name, type, value)) metadata.emplace_back(std::move(name), std::move(value));
        if (file.position() - start > max_metadata && type != "__delayedload")
            file.complain("has more than " + std::to_string(max_metadata >> 20) + " MB of metadata");
    }
    return metadata;
}

const std::string* find(const VdbMetadata& metadata, std::string_view name) {
    for (const auto& [key, value] : metadata)
        if (key == name) return &value;
    return nullptr;
}

// "Tree_float_5_4_3_HalfFloat" is a float tree of the standard shape, stored as half.
void split_type(std::string type, VdbGridEntry& grid) {
    constexpr std::string_view half = "_HalfFloat", tree = "Tree_";
    grid.half = type.ends_with(half);
    if (grid.half) type.resize(type.size() - half.size());
    if (type.starts_with(tree)) type.erase(0, tree.size());
    const size_t end = type.find('_');
    grid.type = type.substr(0, end);
    if (end != std::string::npos) grid.tree_shape = type.substr(end + 1);
}

struct Offsets {
    int64_t grid = 0, voxels = 0, end = 0;
};

// The box of active voxels that OpenVDB notes in a grid's metadata, unless it was told not to.
void read_stated_box(VdbGridEntry& grid) {
    const auto corner = [&](std::string_view name, ivec3& at) {
        const std::string* text = find(grid.metadata, name);
        return text && std::istringstream(*text) >> at.x >> at.y >> at.z;
    };
    ivec3 low, high;
    if (corner("file_bbox_min", low) && corner("file_bbox_max", high)) grid.stated_low = low, grid.stated_high = high;
}

// Reads compression, metadata and transform, from the end of the descriptor up to the tree.
void read_description(ByteCursor& file, VdbGridEntry& grid, bool whole_needed) {
    grid.compression = file.value<uint32_t>("the compression");
    if (grid.compression > 7) file.complain("its compression is unknown: " + std::to_string(grid.compression));
    grid.metadata = read_metadata(file);
    if (const std::string* text = find(grid.metadata, "class")) grid.grid_class = *text;
    read_stated_box(grid);
    const std::string* half = find(grid.metadata, "is_saved_as_half_float");
    if (grid.half != (half && *half == "true"))
        file.complain("its type and its metadata disagree on whether it is stored as half");
    VdbTransform transform = read_transform(file);
    if (!transform.complete && whole_needed) file.complain(transform.problem);
    grid.index_to_world = transform.index_to_world;
    grid.transform_problem = std::move(transform.problem);
}

void check_offsets(ByteCursor& file, const Offsets& offsets, bool instance) {
    const auto here = static_cast<int64_t>(file.position());
    const bool ascending = here <= offsets.grid && offsets.grid <= offsets.end &&
                           (instance || (offsets.grid <= offsets.voxels && offsets.voxels <= offsets.end));
    if (!ascending)
        file.complain("its file offsets are invalid: " + std::to_string(offsets.grid) + " to " +
                      std::to_string(offsets.end));
    if (static_cast<uint64_t>(offsets.end) > file.end())
        refuse(file.where, "is truncated: the grid ends at byte " + std::to_string(offsets.end) +
                               ", the file at byte " + std::to_string(file.end()));
}

VdbGridEntry read_grid(ByteCursor& file, bool has_offsets) {
    VdbGridEntry grid;
    grid.unique_name = file.text(max_text, "a grid name");
    grid.name = grid.unique_name.substr(0, grid.unique_name.find('\x1e'));
    file.where += ": grid \"" + printable(grid.name, 80) + "\"";
    split_type(file.text(max_text, "the grid type"), grid);
    grid.parent = file.text(max_text, "the name of the shared grid");
    const bool instance = !grid.parent.empty();

    const auto offsets = file.value<Offsets>("the offsets");
    if (has_offsets) {
        check_offsets(file, offsets, instance);
        file.seek(static_cast<uint64_t>(offsets.grid), "the grid");
    }
    read_description(file, grid, !has_offsets);

    // Without offsets, finding the next grid requires walking the tree.
    grid.tree_begin = file.position();
    if (has_offsets) {
        if (file.position() > static_cast<uint64_t>(offsets.end)) file.complain("its header extends past its end");
        file.seek(static_cast<uint64_t>(offsets.end), "the end of the grid");
    } else if (!instance) {
        if (!is_walkable(grid))
            file.complain("holds " + printable(grid.type, 40) + " values and the file has no offsets to skip it");
        walk_tree(file, grid);
    }
    grid.tree_end = file.position();
    return grid;
}

void connect_instances(const ByteCursor& file, std::vector<VdbGridEntry>& grids) {
    for (VdbGridEntry& grid : grids) {
        if (grid.parent.empty()) continue;
        const VdbGridEntry* parent = nullptr;
        for (const VdbGridEntry& other : grids)
            if (!parent && other.unique_name == grid.parent && other.parent.empty()) parent = &other;
        if (!parent || parent->type != grid.type || parent->tree_shape != grid.tree_shape)
            refuse(file.where + ": grid \"" + printable(grid.name, 80) + "\"",
                   "shares the voxels of a grid that is missing or of another type: " + printable(grid.parent, 80));
        grid.tree_begin = parent->tree_begin, grid.tree_end = parent->tree_end;
        grid.half = parent->half, grid.compression = parent->compression;
    }
}
}

std::string compression_name(uint32_t flags) {
    std::string name;
    const auto add = [&](const char* part) { name += (name.empty() ? "" : " + ") + std::string(part); };
    if (flags & vdb_zip) add("zip");
    if (flags & vdb_blosc) add("blosc");
    if (flags & vdb_active_mask) add("active values");
    return name.empty() ? "none" : name;
}

VdbDirectory read_directory(ByteCursor& file) {
    if (is_nanovdb(file)) return read_nano_directory(file);
    check_magic(file);
    VdbDirectory directory;
    directory.file_version = file.value<uint32_t>("the header");
    if (directory.file_version < oldest_version || directory.file_version > newest_version)
        file.complain("has file version " + std::to_string(directory.file_version) + "; " +
                      std::to_string(oldest_version) + " to " + std::to_string(newest_version) + " are supported");
    directory.library_major = file.value<uint32_t>("the header");
    directory.library_minor = file.value<uint32_t>("the header");
    const auto has_offsets = file.value<uint8_t>("the header");
    if (has_offsets > 1) file.complain("its header is damaged");
    file.skip(36, "the header"); // UUID

    directory.metadata = read_metadata(file);
    const auto count = file.value<int32_t>("the number of grids");
    if (count < 0 || count > static_cast<int32_t>(max_grids))
        file.complain("claims " + std::to_string(count) + " grids");

    const std::string where = file.where;
    for (int32_t i = 0; i < count; ++i) {
        directory.grids.push_back(read_grid(file, has_offsets != 0));
        file.where = where;
    }
    connect_instances(file, directory.grids);
    return directory;
}
}
