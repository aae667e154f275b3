#include "volume/vdb/inactive_tiles.h"
#include "volume/vdb/library/codec.h"
#include "volume/vdb/library/library_errors.h"
#include "volume/vdb/library/stream.h"

#include <openvdb/Grid.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

namespace tyndall {
namespace {
ivec3 point(const openvdb::Coord& coord) { return {coord.x(), coord.y(), coord.z()}; }

// A value as three numbers; scalars use only the first.
dvec3 numbers_of(double value) { return {value, 0, 0}; }
template<class T> dvec3 numbers_of(const openvdb::math::Vec3<T>& value) { return {value[0], value[1], value[2]}; }

// Calls `visit` with the tiles of any level that an iterator over values finds.
template<class Iterator, class Visit> void visit_tiles(Iterator at, int component, const Visit& visit) {
    at.setMaxDepth(Iterator::LEAF_DEPTH - 1);
    for (; at; ++at) {
        const openvdb::CoordBBox box = at.getBoundingBox();
        visit(Tile{point(box.min()), point(box.max()), static_cast<float>(numbers_of(at.getValue())[component])});
    }
}

// The tree gives the positions of the leaves; their values are decoded in parallel, bypassing the library's tree.
template<class Tree>
void append_leaves(const Tree& tree, std::string_view bytes, std::span<const uint64_t> begins, const LeafCoding& coding,
                   DecodedTree& result) {
    std::vector<const typename Tree::LeafNodeType*> nodes;
    nodes.reserve(begins.size());
    tree.getNodes(nodes);
    if (nodes.size() != begins.size()) throw std::runtime_error("the tree has the wrong number of leaves");
    result.leaves.reserve(nodes.size());
    for (const auto* node : nodes) result.leaves.emplace_back(Unfilled{}).origin = point(node->origin());
    result.active.resize(nodes.size());
    decode_leaves(bytes, begins, coding, result.leaves, result.active);
}

// The tree is read from an in-memory stream that throws on errors, so nothing is memory-mapped or loaded lazily. Grids
// come from the library's registry: creating them here would compile every member of every tree type.
template<class Grid>
DecodedTree decoded(std::string_view bytes, const VdbGridEntry& entry, VdbTreeCounts& counts, LeafCoding coding,
                    const std::string& where) {
    openvdb::initialize();
    const openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid("Tree_" + entry.type + "_5_4_3");
    const size_t topology_end = counts.leaf_begins.empty() ? bytes.size() : counts.leaf_begins.front();
    {
        ByteSource source(bytes);
        std::istream stream(&source);
        stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
        openvdb::io::setVersion(stream, openvdb::VersionId(0, 0), coding.file_version);
        openvdb::io::setDataCompression(stream, entry.compression);
        grid->setSaveFloatAsHalf(entry.half);
        grid->readTopology(stream);
        if (source.taken() != topology_end) throw std::runtime_error("the tree has the wrong length");
    }
    const auto& tree = static_cast<const Grid&>(*grid).tree();
    DecodedTree result;
    coding.background = numbers_of(tree.background());
    result.background = static_cast<float>(coding.background[coding.component]);
    for (auto at = tree.root().cbeginChildAll(); at; ++at) result.root_nodes.push_back(point(at.getCoord()));
    visit_tiles(tree.cbeginValueOn(), coding.component, [&](const Tile& tile) { result.active_tiles.push_back(tile); });
    append_leaves(tree, bytes, counts.leaf_begins, coding, result);
    const auto visit_inactive = [&](const auto& visit) { visit_tiles(tree.cbeginValueOff(), coding.component, visit); };
    store_inactive_tiles(visit_inactive, bytes.size(), where, counts, result);
    return result;
}
}

DecodedTree decode_tree(std::string_view bytes, const VdbGridEntry& grid, VdbTreeCounts& counts, uint32_t file_version,
                        const std::string& where, int component) {
    LeafCoding coding{file_version, grid.compression, grid.half, LeafValue::single, component, dvec3(0)};
    const auto as = [&]<class Grid>(LeafValue value, std::type_identity<Grid>) {
        coding.value = value;
        return decoded<Grid>(bytes, grid, counts, coding, where);
    };
    return with_library_errors(ExitCode::refused, where, [&] {
        if (grid.type == "vec3s") return as(LeafValue::three_single, std::type_identity<openvdb::Vec3SGrid>());
        if (grid.type == "vec3d") return as(LeafValue::three_wide, std::type_identity<openvdb::Vec3DGrid>());
        if (grid.type == "double") return as(LeafValue::wide, std::type_identity<openvdb::DoubleGrid>());
        return as(LeafValue::single, std::type_identity<openvdb::FloatGrid>());
    });
}
}
