#include "volume/vdb/codec.h"

#include "base/error.h"
#include "base/io/file.h"
#include "volume/vdb/head.h"
#include "volume/vdb/stream.h"
#include "volume/vdb/tree_order.h"

#include <openvdb/Grid.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <new>
#include <sstream>

namespace tyndall {
namespace {
// Library messages can be gigabytes long and out of memory has an exit code of its own: no exception passes as it is.
template<class Body> auto guarded(ExitCode code, const std::string& where, const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        fail(ExitCode::out_of_memory, where, "does not fit into memory");
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        fail(code, where, "OpenVDB says: " + printable(error.what(), 160));
    }
}

constexpr size_t max_tiles = size_t{1} << 26; // a few bytes in a file can stand for thousands of them

ivec3 point(const openvdb::Coord& coord) { return {coord.x(), coord.y(), coord.z()}; }

// A value as three numbers; of numbers the first alone counts.
dvec3 numbers_of(double value) { return {value, 0, 0}; }
template<class T> dvec3 numbers_of(const openvdb::math::Vec3<T>& value) { return {value[0], value[1], value[2]}; }

// The one value tells active from inactive, whatever the level of the tile.
template<class Iterator> void append_tile(const Iterator& at, bool active, int component, DecodedTree& result) {
    const openvdb::CoordBBox box = at.getBoundingBox();
    const Tile tile{point(box.min()), point(box.max()), static_cast<float>(numbers_of(at.getValue())[component])};
    if (active)
        result.active_tiles.push_back(tile);
    else if (tile.value != 0)
        result.inactive_tiles.push_back(tile);
}

template<class Tree> void append_tiles(const Tree& tree, int component, DecodedTree& result) {
    auto on = tree.cbeginValueOn();
    on.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; on; ++on) append_tile(on, true, component, result);
    auto off = tree.cbeginValueOff();
    off.setMaxDepth(Tree::ValueOffCIter::LEAF_DEPTH - 1);
    for (; off; ++off) append_tile(off, false, component, result);
}

// The tree gives the places of the leaves; their values are decoded in parallel, past the library's tree.
template<class Tree>
void append_leaves(const Tree& tree, std::string_view bytes, std::span<const uint64_t> begins, const LeafCoding& coding,
                   DecodedTree& result) {
    std::vector<const typename Tree::LeafNodeType*> nodes;
    nodes.reserve(begins.size());
    tree.getNodes(nodes);
    if (nodes.size() != begins.size()) throw std::runtime_error("the tree holds another number of leaves");
    result.leaves.reserve(nodes.size());
    for (const auto* node : nodes) result.leaves.emplace_back(Unfilled{}).origin = point(node->origin());
    result.active.resize(nodes.size());
    decode_leaves(bytes, begins, coding, result.leaves, result.active);
}

// The tree is read from a stream that throws and has no file behind it, so nothing is mapped or loaded late.
// Grids come from the library's registry: making them here would compile every member of every type of tree.
template<class Grid>
DecodedTree decoded(std::string_view bytes, const VdbGridEntry& entry, const VdbTreeCounts& counts, LeafCoding coding) {
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
        if (source.taken() != topology_end) throw std::runtime_error("the tree ends elsewhere than its bytes do");
    }
    const auto& tree = static_cast<const Grid&>(*grid).tree();
    DecodedTree result;
    coding.background = numbers_of(tree.background());
    result.background = static_cast<float>(coding.background[coding.component]);
    for (auto at = tree.root().cbeginChildAll(); at; ++at) result.root_nodes.push_back(point(at.getCoord()));
    append_tiles(tree, coding.component, result);
    append_leaves(tree, bytes, counts.leaf_begins, coding, result);
    return result;
}

void fill_tiles(openvdb::FloatTree& tree, const std::vector<Tile>& tiles, bool half) {
    for (const Tile& tile : tiles) {
        const float value = stored_value(tile.value, half);
        if (value == 0) continue;
        const openvdb::Coord low(tile.low.x, tile.low.y, tile.low.z), high(tile.high.x, tile.high.y, tile.high.z);
        tree.sparseFill(openvdb::CoordBBox(low, high), value, true);
    }
}

// The leaves that tiles made where they cover one in part.
Leaves leaves_of_tiles(const openvdb::FloatTree& tree) {
    Leaves leaves;
    for (auto node = tree.cbeginLeaf(); node; ++node) {
        Leaf& leaf = leaves.emplace_back(Leaf{point(node->origin())});
        for (openvdb::Index v = 0; v < 512; ++v) leaf.values[v] = node->getValue(v);
    }
    return leaves;
}

// Puts a leaf into the tree with its mask but without values, which are encoded apart.
void add_leaf(openvdb::FloatTree& tree, ivec3 origin, const VoxelMask& voxels) {
    using Node = openvdb::FloatTree::LeafNodeType;
    auto node = std::make_unique<Node>(openvdb::PartialCreate(), openvdb::Coord(origin.x, origin.y, origin.z), 0.f);
    Node::NodeMaskType mask;
    for (openvdb::Index w = 0; w < 8; ++w) mask.getWord<openvdb::Index64>(w) = voxels[w];
    node->setValueMask(mask);
    tree.addLeaf(node.release());
}

// Tiles and leaves as a tree without the values of leaves; those, in its order.
EncodedLeaves encode_tree(openvdb::FloatTree& tree, const VdbContent& content, bool half, uint32_t packing) {
    fill_tiles(tree, content.tiles, half);
    const Leaves more = leaves_of_tiles(tree);
    const size_t given = content.origins.size();
    std::vector<ivec3> origins = content.origins;
    for (const Leaf& leaf : more) origins.push_back(leaf.origin);
    const std::vector<uint32_t> order = in_tree_order(origins);
    const auto fill = [&](size_t n, Leaf& leaf) {
        const size_t number = order[n];
        number < given ? content.fill(number, leaf) : void(leaf = more[number - given]);
    };
    EncodedLeaves leaves = encode_leaves(order.size(), fill, half, packing);
    size_t added = 0;
    for (size_t n = 0; n < order.size(); ++n) {
        if (count_voxels(leaves.masks[n]) == 0) continue;
        add_leaf(tree, origins[order[n]], leaves.masks[n]);
        ++added;
    }
    if (tree.leafCount() != added) throw std::runtime_error("two leaves share an origin");
    return leaves;
}

// Scale and translation as such, since some readers know no other map; anything else as a matrix.
openvdb::math::Transform make_transform(const dmat4& matrix) {
    using namespace openvdb::math;
    openvdb::Mat4d rows;
    bool diagonal = true;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            rows(i, j) = matrix[i][j];
            if (i != j && i != 3 && matrix[i][j] != 0) diagonal = false;
        }
    if (!diagonal) return Transform(std::make_shared<AffineMap>(rows));
    const openvdb::Vec3d scale(matrix[0][0], matrix[1][1], matrix[2][2]);
    const openvdb::Vec3d translation(matrix[3][0], matrix[3][1], matrix[3][2]);
    return Transform(std::make_shared<ScaleTranslateMap>(scale, translation));
}

// As the library lays a grid out, but with ZIP when asked for: it never packs a fog volume so. What follows the
// topology are the values; the leaves hold none, but count as if they did in the memory that the grid says it takes.
void write_grid(std::ostream& stream, openvdb::FloatGrid& grid, uint32_t compression,
                std::span<const std::string_view> values) {
    using namespace openvdb;
    io::GridDescriptor descriptor(grid.getName(), grid.type(), grid.saveFloatAsHalf());
    descriptor.writeHeader(stream);
    const std::streampos offsets = stream.tellp();
    descriptor.writeStreamPos(stream);

    descriptor.setGridPos(stream.tellp());
    io::setDataCompression(stream, compression);
    write_value(stream, compression);
    grid.addStatsMetadata();
    const auto memory = static_cast<int64_t>(grid.memUsage() + grid.tree().leafCount() * 512 * sizeof(float));
    grid.insertMeta(GridBase::META_FILE_MEM_BYTES, Int64Metadata(memory));
    grid.insertMeta(GridBase::META_FILE_COMPRESSION, StringMetadata(io::compressionToString(compression)));
    grid.writeMeta(stream);
    grid.writeTransform(stream);
    grid.writeTopology(stream);
    std::streamoff end = stream.tellp();
    descriptor.setBlockPos(end);
    for (const std::string_view piece : values) end += static_cast<std::streamoff>(piece.size());
    descriptor.setEndPos(end);

    stream.seekp(offsets);
    descriptor.writeStreamPos(stream);
}
}

DecodedTree decode_tree(std::string_view bytes, const VdbGridEntry& grid, const VdbTreeCounts& counts,
                        uint32_t file_version, const std::string& where, int component) {
    LeafCoding coding{file_version, grid.compression, grid.half, LeafValue::single, component, dvec3(0)};
    const auto as = [&]<class Grid>(LeafValue value, std::type_identity<Grid>) {
        coding.value = value;
        return decoded<Grid>(bytes, grid, counts, coding);
    };
    return guarded(ExitCode::refused, where, [&] {
        if (grid.type == "vec3s") return as(LeafValue::three_single, std::type_identity<openvdb::Vec3SGrid>());
        if (grid.type == "vec3d") return as(LeafValue::three_wide, std::type_identity<openvdb::Vec3DGrid>());
        if (grid.type == "double") return as(LeafValue::wide, std::type_identity<openvdb::DoubleGrid>());
        return as(LeafValue::single, std::type_identity<openvdb::FloatGrid>());
    });
}

std::vector<std::string_view> EncodedFog::pieces() const {
    std::vector<std::string_view> result{head};
    result.insert(result.end(), leaves.pieces.begin(), leaves.pieces.end());
    return result;
}

uint64_t EncodedFog::voxels() const {
    uint64_t sum = 0;
    for (const VoxelMask& mask : leaves.masks) sum += count_voxels(mask);
    return sum;
}

EncodedFog encode_fog(const VdbContent& content, const VdbWriteOptions& options, const std::string& where) {
    return guarded(ExitCode::internal, where, [&] {
        using namespace openvdb;
        initialize();
        const GridBase::Ptr base = GridBase::createGrid(FloatGrid::gridType());
        auto& grid = static_cast<FloatGrid&>(*base);
        grid.setName(content.name);
        grid.setGridClass(GRID_FOG_VOLUME);
        grid.setCreator(options.creator);
        grid.setSaveFloatAsHalf(options.half);
        grid.setTransform(std::make_shared<math::Transform>(make_transform(content.index_to_world)));

        // The values first: how many bytes they take stands before them.
        const uint32_t packing = options.blosc ? io::COMPRESS_BLOSC : io::COMPRESS_ZIP;
        EncodedFog fog;
        fog.leaves = encode_tree(grid.tree(), content, options.half, packing);

        std::ostringstream stream(std::ios::binary);
        stream.exceptions(std::ios::failbit | std::ios::badbit);
        write_head(stream, content.metadata, options.creator);
        write_grid(stream, grid, io::COMPRESS_ACTIVE_MASK | packing, fog.leaves.pieces);
        fog.head = std::move(stream).str();

        // The same content gets the same identity.
        set_identity(fog.head, content_hash(fog.pieces()));
        return fog;
    });
}
}
