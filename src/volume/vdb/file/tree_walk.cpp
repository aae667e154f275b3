// Walks the tree of a grid in file order: first the topology (root, 32³ and 16³ nodes, voxel masks), then, in the same
// order, the values of every leaf, in compressed chunks that may hold active values only.
#include "volume/vdb/file/prewalk.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace tyndall {
namespace {
enum class LeafKind { values, booleans, mask };

struct TreeFormat {
    const char* type;
    uint64_t value_bytes, half_bytes; // half_bytes 0: no half storage
    LeafKind leaf = LeafKind::values;
};

constexpr TreeFormat formats[] = {
    {"float", 4, 2},
    {"double", 8, 2},
    {"vec3s", 12, 6},
    {"vec3d", 24, 6},
    {"int32", 4, 0},
    {"int64", 8, 0},
    {"vec3i", 12, 0},
    {"bool", 1, 0, LeafKind::booleans},
    {"mask", 1, 0, LeafKind::mask},
};

const TreeFormat* find_format(const VdbGridEntry& grid) {
    if (grid.tree_shape != "5_4_3") return nullptr;
    const auto found = std::ranges::find_if(formats, [&](const TreeFormat& f) { return grid.type == f.type; });
    return found == std::end(formats) ? nullptr : found;
}

template<size_t Bits> struct Mask {
    std::array<uint64_t, Bits / 64> words;

    void read(ByteCursor& file, const char* what) { file.read(words.data(), sizeof words, what); }
    uint64_t count() const {
        uint64_t sum = 0;
        for (const uint64_t word : words) sum += static_cast<uint64_t>(std::popcount(word));
        return sum;
    }
    bool overlaps(const Mask& other) const {
        for (size_t i = 0; i < words.size(); ++i)
            if (words[i] & other.words[i]) return true;
        return false;
    }
};

// Order-dependent checksum of the voxel masks, which are stored twice and must agree.
struct MaskSum {
    uint64_t value = 0x9e3779b97f4a7c15u;

    void add(const Mask<512>& mask) {
        for (const uint64_t word : mask.words) value = (std::rotl(value, 5) ^ word) * 0x2545f4914f6cdd1du;
    }
};

class TreeWalk {
public:
    TreeWalk(ByteCursor& file, const VdbGridEntry& grid, const TreeFormat& format)
        : file_(file), first_(file.position()), compression_(grid.compression), format_(format),
          stored_bytes_(grid.half && format.half_bytes ? format.half_bytes : format.value_bytes),
          half_(grid.half && format.half_bytes) {}

    VdbTreeCounts walk() {
        read_root();
        const uint64_t topology_sum = topology_.value;
        for (uint64_t leaf = 0; leaf < counts_.leaves; ++leaf) {
            counts_.leaf_begins.push_back(file_.position() - first_);
            read_leaf_values();
        }
        if (buffers_.value != topology_sum) file_.complain("its voxel masks contradict its topology");
        return counts_;
    }

private:
    void read_root();
    void read_root_key(std::array<int32_t, 3>& key);
    void read_upper_node();
    void read_lower_node();
    void read_leaf_values();
    template<size_t Bits> void read_values(const Mask<Bits>& active);
    void read_chunk(uint64_t bytes);
    void check_blosc_header(uint64_t chunk, uint64_t bytes);

    ByteCursor& file_;
    uint64_t first_;
    uint32_t compression_;
    const TreeFormat& format_;
    uint64_t stored_bytes_;
    bool half_;
    VdbTreeCounts counts_;
    MaskSum topology_, buffers_;
};

void TreeWalk::read_root_key(std::array<int32_t, 3>& key) {
    key = file_.value<std::array<int32_t, 3>>("a root node");
    for (const int32_t c : key) {
        if (c & 4095) file_.complain("a root node lies at " + std::to_string(c) + ", not a multiple of 4096");
        if (c < -largest_coordinate || c > largest_coordinate - 4096)
            file_.complain("a root node lies at " + std::to_string(c) + ", more than 2^24 voxels from the origin");
    }
}

void TreeWalk::read_root() {
    if (file_.value<int32_t>("the tree") != 1) file_.complain("its tree must have exactly one buffer");
    file_.skip(format_.value_bytes, "the background");
    const auto tiles = file_.value<uint32_t>("the number of root tiles");
    const auto nodes = file_.value<uint32_t>("the number of root nodes");
    if (tiles > file_.left() / (13 + format_.value_bytes) || nodes > file_.left() / (12 + 2 * 4096))
        file_.complain("is truncated or damaged: claims " + std::to_string(tiles) + " root tiles and " +
                       std::to_string(nodes) + " root nodes");

    std::vector<std::array<int32_t, 3>> keys(uint64_t{tiles} + nodes);
    for (uint32_t i = 0; i < tiles; ++i) {
        read_root_key(keys[i]);
        file_.skip(format_.value_bytes, "a root tile");
        const auto active = file_.value<uint8_t>("a root tile");
        if (active > 1) file_.complain("a root tile is damaged");
        counts_.active_tiles += active, counts_.active_voxels += active * (uint64_t{1} << 36);
    }
    counts_.root_tiles = tiles;

    // Leaf values follow in the order of the keys, so any other order would assign values to the wrong leaves.
    for (uint32_t i = 0; i < nodes; ++i) {
        read_root_key(keys[tiles + i]);
        if (i > 0 && !(keys[tiles + i - 1] < keys[tiles + i])) file_.complain("its root nodes are not in order");
        read_upper_node();
    }
    std::ranges::sort(keys);
    if (std::ranges::adjacent_find(keys) != keys.end()) file_.complain("duplicate root node");
}

void TreeWalk::read_upper_node() {
    Mask<32768> children, active;
    children.read(file_, "an internal node"), active.read(file_, "an internal node");
    if (children.overlaps(active)) file_.complain("an internal node has a child and a value in the same slot");
    ++counts_.upper_nodes;
    const uint64_t tiles = active.count();
    counts_.active_tiles += tiles, counts_.active_voxels += tiles << 21;
    read_values(active);
    for (uint64_t child = children.count(); child > 0; --child) read_lower_node();
}

void TreeWalk::read_lower_node() {
    Mask<4096> children, active;
    children.read(file_, "an internal node"), active.read(file_, "an internal node");
    if (children.overlaps(active)) file_.complain("an internal node has a child and a value in the same slot");
    ++counts_.lower_nodes;
    const uint64_t tiles = active.count();
    counts_.active_tiles += tiles, counts_.active_voxels += tiles << 9;
    read_values(active);
    for (uint64_t child = children.count(); child > 0; --child) {
        Mask<512> voxels;
        voxels.read(file_, "a leaf");
        topology_.add(voxels);
        ++counts_.leaves, counts_.active_voxels += voxels.count();
    }
}

void TreeWalk::read_leaf_values() {
    Mask<512> active;
    active.read(file_, "the voxels of a leaf");
    buffers_.add(active);
    switch (format_.leaf) {
    case LeafKind::values:
        return read_values(active);
    case LeafKind::booleans:
        return file_.skip(12 + 64, "the voxels of a leaf");
    case LeafKind::mask:
        return file_.skip(12, "the voxels of a leaf");
    }
}

// A byte says how inactive values are stored: 0..5 as at most two values and a mask, 6 as all values in full.
template<size_t Bits> void TreeWalk::read_values(const Mask<Bits>& active) {
    constexpr int8_t one_value = 2, mask_only = 3, mask_and_value = 4, mask_and_two = 5, all_values = 6;
    const auto kind = file_.value<int8_t>("the values of a node");
    if (kind < 0 || kind > all_values)
        file_.complain("the values of a node are of an unknown kind: " + std::to_string(kind));
    if (kind == one_value || kind == mask_and_value) file_.skip(format_.value_bytes, "an inactive value");
    if (kind == mask_and_two) file_.skip(2 * format_.value_bytes, "inactive values");
    if (kind >= mask_only && kind <= mask_and_two) file_.skip(Bits / 8, "a mask of inactive values");

    const bool active_only = (compression_ & vdb_active_mask) && kind != all_values;
    const uint64_t count = active_only ? active.count() : Bits;
    if (half_ && count == 0) return; // the writer omits empty chunks of halves
    read_chunk(count * stored_bytes_);
}

// Compressed chunks are preceded by their length, negative if stored uncompressed because they would not shrink.
void TreeWalk::read_chunk(uint64_t bytes) {
    constexpr uint64_t max_overhead = 16;
    if (!(compression_ & (vdb_zip | vdb_blosc))) return file_.skip(bytes, "the values of a node");
    const auto length = file_.value<int64_t>("the length of a chunk");
    const auto size = static_cast<uint64_t>(length);
    const bool raw = length <= 0;
    if (raw ? 0 - size != bytes : size > bytes + max_overhead)
        file_.complain("a chunk of " + std::to_string(bytes) + " bytes of values has an invalid length of " +
                       std::to_string(length));
    if (!raw && (compression_ & vdb_blosc)) return check_blosc_header(size, bytes);
    file_.skip(raw ? bytes : size, "the values of a node");
}

// Blosc trusts its own header: version, codec version, flags, type size; then uncompressed, block and compressed size.
void TreeWalk::check_blosc_header(uint64_t chunk, uint64_t bytes) {
    constexpr uint64_t header_bytes = 16;
    if (chunk < header_bytes) file_.complain("a compressed chunk is shorter than its header");
    file_.skip(4, "a compressed chunk");
    const auto sizes = file_.value<std::array<uint32_t, 3>>("a compressed chunk");
    if (sizes[0] != bytes || sizes[2] != chunk || (bytes > 0 && (sizes[1] == 0 || sizes[1] > bytes)))
        file_.complain("the header of a compressed chunk has the wrong size");
    file_.skip(chunk - header_bytes, "the values of a node");
}
}

bool is_walkable(const VdbGridEntry& grid) { return find_format(grid) != nullptr; }

bool is_scalar_float(const VdbGridEntry& grid) {
    return is_walkable(grid) && (grid.type == "float" || grid.type == "double");
}

bool is_vector_float(const VdbGridEntry& grid) {
    return is_walkable(grid) && (grid.type == "vec3s" || grid.type == "vec3d");
}

VdbTreeCounts walk_tree(ByteCursor& bytes, const VdbGridEntry& grid) {
    const TreeFormat* format = find_format(grid);
    if (!format) bytes.complain("has values of an unsupported type: " + printable(grid.type, 40));
    return TreeWalk(bytes, grid, *format).walk();
}
}
