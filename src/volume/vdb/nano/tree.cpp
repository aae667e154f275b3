#include "volume/vdb/nano/tree.h"

#include "base/error.h"
#include "base/parallel.h"
#include "volume/vdb/inactive_tiles.h"

#include <nanovdb/NanoVDB.h>

#include <algorithm>
#include <cstring>
#include <tuple>

namespace tyndall {
namespace {
float component_of(float value, int) { return value; }
float component_of(double value, int) { return static_cast<float>(value); }
template<class T> float component_of(const nanovdb::Vec3<T>& value, int component) {
    return static_cast<float>(value[component]);
}

// Position of child `number`, in units of children, in a node with 2^bits children per side.
ivec3 place(uint32_t number, uint32_t bits) {
    const uint32_t mask = (1u << bits) - 1;
    return {number >> 2 * bits, number >> bits & mask, number & mask};
}

template<class Build> class NanoWalk {
    using Leaf = typename nanovdb::NanoLeaf<Build>::DataType;
    using Lower = typename nanovdb::NanoLower<Build>::DataType;
    using Upper = typename nanovdb::NanoUpper<Build>::DataType;
    using Root = typename nanovdb::NanoRoot<Build>::DataType;

public:
    NanoWalk(std::string_view bytes, VdbTreeCounts& counts, const std::string& where, int component)
        : bytes_(bytes), counts_(counts), where_(where), component_(component) {}

    DecodedTree walk() {
        const auto& tree = node<nanovdb::TreeData<3>>(sizeof(nanovdb::GridData), 0);
        const Root& root = node<Root>(offset_of(tree), static_cast<int64_t>(tree.mNodeOffset[3]));
        read_root(root);
        fill_leaves();
        const auto visit_inactive = [&](const auto& visit) { visit_inactive_tiles(root, visit); };
        store_inactive_tiles(visit_inactive, bytes_.size(), where_, counts_, result_);
        return std::move(result_);
    }

private:
    template<class Node> uint64_t offset_of(const Node& node) const {
        return static_cast<uint64_t>(reinterpret_cast<const char*>(&node) - bytes_.data());
    }

    // The node `step` bytes after offset `from`; must lie entirely within the grid.
    template<class Node> const Node& node(uint64_t from, int64_t step) const {
        const uint64_t at = from + static_cast<uint64_t>(step);
        if (at % NANOVDB_DATA_ALIGNMENT || at > bytes_.size() || bytes_.size() - at < sizeof(Node))
            refuse(where_, "is damaged: a node points outside the grid");
        return *reinterpret_cast<const Node*>(bytes_.data() + at);
    }
    template<class Node, class From> const Node& child(const From& from, int64_t step) const {
        return node<Node>(offset_of(from), step);
    }

    // In a tree every node has one parent, so there cannot be more nodes than fit in the grid.
    template<class Node> void count(uint64_t& nodes) const {
        if (++nodes > bytes_.size() / sizeof(Node)) refuse(where_, "is damaged: nodes share a child");
    }

    void add_active_tile(ivec3 low, int size, float value) {
        result_.active_tiles.push_back({low, low + size - 1, value});
        ++counts_.active_tiles, counts_.active_voxels += uint64_t(size) * uint64_t(size) * uint64_t(size);
    }

    void read_root(const Root& root) {
        result_.background = component_of(root.mBackground, component_);
        const uint64_t after = bytes_.size() - offset_of(root) - sizeof(Root);
        if (root.mTableSize > after / sizeof(typename Root::Tile))
            refuse(where_, "is damaged: claims " + std::to_string(root.mTableSize) + " root nodes");
        for (uint32_t n = 0; n < root.mTableSize; ++n) {
            const typename Root::Tile& tile = *root.tile(n);
            const auto origin = tile.origin();
            const ivec3 low(origin[0], origin[1], origin[2]);
            for (int axis = 0; axis < 3; ++axis)
                if (low[axis] < -largest_coordinate || low[axis] > largest_coordinate - 4096)
                    refuse(where_, "a root node lies more than 2^24 voxels from the origin");
            result_.root_nodes.push_back(low);
            if (tile.child != 0) {
                read_upper(child<Upper>(root, tile.child), low);
            } else {
                ++counts_.root_tiles;
                if (tile.state != 0) add_active_tile(low, 4096, component_of(tile.value, component_));
            }
        }
        check_places();
    }

    void check_places() const {
        std::vector<ivec3> places = result_.root_nodes;
        std::ranges::sort(places, {}, [](ivec3 p) { return std::tuple(p.x, p.y, p.z); });
        if (std::ranges::adjacent_find(places) != places.end()) refuse(where_, "duplicate root node");
    }

    // Visits every child of an internal node and adds its active tiles.
    template<class Node, class OnChild>
    void read_children(const Node& node, ivec3 low, uint32_t bits, int size, const OnChild& on_child) {
        for (uint32_t n = 0; n < 1u << 3 * bits; ++n) {
            const ivec3 at = low + place(n, bits) * size;
            if (node.mChildMask.isOn(n))
                on_child(node.mTable[n].child, at);
            else if (node.mValueMask.isOn(n))
                add_active_tile(at, size, component_of(node.mTable[n].value, component_));
        }
    }

    void read_upper(const Upper& upper, ivec3 low) {
        count<Upper>(counts_.upper_nodes);
        uppers_.emplace_back(&upper, low);
        read_children(upper, low, 5, 128, [&](int64_t step, ivec3 at) { read_lower(child<Lower>(upper, step), at); });
    }

    void read_lower(const Lower& lower, ivec3 low) {
        count<Lower>(counts_.lower_nodes);
        lowers_.emplace_back(&lower, low);
        read_children(lower, low, 4, 8, [&](int64_t step, ivec3 at) { add_leaf(child<Leaf>(lower, step), at); });
    }

    void add_leaf(const Leaf& leaf, ivec3 low) {
        count<Leaf>(counts_.leaves);
        if constexpr (std::is_same_v<Build, nanovdb::FpN>) { // variable size: values follow the node
            if (leaf.mFlags >> 5 > 4 || bytes_.size() - offset_of(leaf) < leaf.memUsage())
                refuse(where_, "is damaged: the values of a leaf lie outside the grid");
        }
        leaves_.emplace_back(&leaf, low);
    }

    void fill_leaves() {
        check_tree(counts_, bytes_.size(), where_);
        result_.leaves.reserve(leaves_.size());
        for (const auto& [leaf, origin] : leaves_) result_.leaves.emplace_back(Unfilled{}).origin = origin;
        result_.active.resize(leaves_.size());
        parallel_ranges(static_cast<int64_t>(leaves_.size()), 64, [&](int64_t begin, int64_t end) {
            for (auto n = static_cast<size_t>(begin); n < static_cast<size_t>(end); ++n) {
                const Leaf& leaf = *leaves_[n].first;
                static_assert(sizeof leaf.mValueMask == sizeof(VoxelMask));
                std::memcpy(&result_.active[n], &leaf.mValueMask, sizeof(VoxelMask));
                for (uint32_t v = 0; v < 512; ++v)
                    result_.leaves[n].values[v] = component_of(leaf.getValue(v), component_);
            }
        });
        for (const VoxelMask& mask : result_.active) counts_.active_voxels += count_voxels(mask);
    }

    template<class Node, class Visit>
    void visit_inactive(const Node& node, ivec3 low, uint32_t bits, int size, const Visit& visit) const {
        for (uint32_t n = 0; n < 1u << 3 * bits; ++n) {
            if (node.mChildMask.isOn(n) || node.mValueMask.isOn(n)) continue;
            const ivec3 at = low + place(n, bits) * size;
            visit(Tile{at, at + size - 1, component_of(node.mTable[n].value, component_)});
        }
    }
    template<class Visit> void visit_inactive_tiles(const Root& root, const Visit& visit) const {
        for (uint32_t n = 0; n < root.mTableSize; ++n)
            if (const typename Root::Tile& tile = *root.tile(n); tile.child == 0 && tile.state == 0) {
                const auto origin = tile.origin();
                const ivec3 low(origin[0], origin[1], origin[2]);
                visit(Tile{low, low + 4095, component_of(tile.value, component_)});
            }
        for (const auto& [upper, low] : uppers_) visit_inactive(*upper, low, 5, 128, visit);
        for (const auto& [lower, low] : lowers_) visit_inactive(*lower, low, 4, 8, visit);
    }

    std::string_view bytes_;
    VdbTreeCounts& counts_;
    const std::string& where_;
    int component_;
    std::vector<std::pair<const Upper*, ivec3>> uppers_;
    std::vector<std::pair<const Lower*, ivec3>> lowers_;
    std::vector<std::pair<const Leaf*, ivec3>> leaves_;
    DecodedTree result_;
};
}

DecodedTree decode_nano_tree(std::string_view bytes, const VdbGridEntry& grid, VdbTreeCounts& counts,
                             const std::string& where, int component) {
    const auto as = [&]<class Build>(std::type_identity<Build>) {
        return NanoWalk<Build>(bytes, counts, where, component).walk();
    };
    using enum nanovdb::GridType;
    switch (static_cast<nanovdb::GridType>(grid.nano_type)) {
    case Float:
        return as(std::type_identity<float>());
    case Double:
        return as(std::type_identity<double>());
    case Vec3f:
        return as(std::type_identity<nanovdb::Vec3f>());
    case Vec3d:
        return as(std::type_identity<nanovdb::Vec3d>());
    case Fp4:
        return as(std::type_identity<nanovdb::Fp4>());
    case Fp8:
        return as(std::type_identity<nanovdb::Fp8>());
    case Fp16:
        return as(std::type_identity<nanovdb::Fp16>());
    case FpN:
        return as(std::type_identity<nanovdb::FpN>());
    default:
        refuse(where, "has values of an unsupported type: " + printable(grid.type, 40));
    }
}
}
