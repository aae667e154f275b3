#include "volume/vdb/library/codec.h"

#include "base/io/file.h"
#include "volume/vdb/file/head.h"
#include "volume/vdb/library/library_errors.h"
#include "volume/vdb/library/stream.h"
#include "volume/vdb/tree_order.h"

#include <openvdb/Grid.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <sstream>

namespace tyndall {
namespace {
void fill_tiles(openvdb::FloatTree& tree, const std::vector<Tile>& tiles, bool half) {
    for (const Tile& tile : tiles) {
        const float value = stored_value(tile.value, half);
        if (value == 0) continue;
        const openvdb::Coord low(tile.low.x, tile.low.y, tile.low.z), high(tile.high.x, tile.high.y, tile.high.z);
        tree.sparseFill(openvdb::CoordBBox(low, high), value, true);
    }
}

// The leaves created by tiles that cover them only in part.
Leaves leaves_of_tiles(const openvdb::FloatTree& tree) {
    Leaves leaves;
    for (auto node = tree.cbeginLeaf(); node; ++node) {
        const openvdb::Coord origin = node->origin();
        Leaf& leaf = leaves.emplace_back(Leaf{{origin.x(), origin.y(), origin.z()}});
        for (openvdb::Index v = 0; v < 512; ++v) leaf.values[v] = node->getValue(v);
    }
    return leaves;
}

// Adds leaves to the tree with their masks but without values, which are encoded separately.
template<class Tree> void add_leaves(Tree& tree, std::span<const ivec3> origins, std::span<const VoxelMask> masks) {
    using Node = typename Tree::LeafNodeType;
    size_t added = 0;
    for (size_t n = 0; n < origins.size(); ++n) {
        if (count_voxels(masks[n]) == 0) continue;
        const openvdb::Coord origin(origins[n].x, origins[n].y, origins[n].z);
        auto node = std::make_unique<Node>(openvdb::PartialCreate(), origin, typename Tree::ValueType(0));
        typename Node::NodeMaskType mask;
        for (openvdb::Index w = 0; w < 8; ++w) mask.template getWord<openvdb::Index64>(w) = masks[n][w];
        node->setValueMask(mask);
        tree.addLeaf(node.release());
        ++added;
    }
    if (tree.leafCount() != added) throw std::runtime_error("two leaves have the same origin");
}

// The leaves of a file in tree order, including those that tiles cover only in part.
struct OrderedLeaves {
    std::vector<ivec3> origins;
    EncodedLeaves encoded;
};

OrderedLeaves encode_in_order(const VdbContent& content, const Leaves& more, bool half, uint32_t packing) {
    const size_t given = content.origins.size();
    std::vector<ivec3> origins = content.origins;
    for (const Leaf& leaf : more) origins.push_back(leaf.origin);
    const std::vector<uint32_t> order = in_tree_order(origins);
    const auto fill = [&](size_t n, std::span<Leaf> leaves) {
        const size_t number = order[n];
        number < given ? content.fill(number, leaves) : void(leaves[0] = more[number - given]);
    };
    OrderedLeaves result{{}, encode_leaves(order.size(), content.grids, fill, half, packing)};
    for (const uint32_t number : order) result.origins.push_back(origins[number]);
    return result;
}

// Uses a ScaleTranslateMap if possible, because some readers support no other; else a matrix.
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

// Writes a grid in the library's layout, but allows ZIP, which the library never uses for fog volumes. `values` follow
// the topology; the tree's leaves hold none, but the memory metadata counts them. `before`: bytes of the file that
// precede the stream.
void write_grid(std::ostream& stream, uint64_t before, openvdb::GridBase& grid, uint32_t compression,
                std::span<const std::string_view> values) {
    using namespace openvdb;
    io::GridDescriptor descriptor(grid.getName(), grid.type(), grid.saveFloatAsHalf());
    descriptor.writeHeader(stream);
    const std::streampos offsets = stream.tellp();
    descriptor.writeStreamPos(stream);
    const auto position = [&] { return stream.tellp() + static_cast<std::streamoff>(before); };

    descriptor.setGridPos(position());
    io::setDataCompression(stream, compression);
    write_value(stream, compression);
    grid.addStatsMetadata();
    const size_t voxel_bytes = (grid.isType<openvdb::Vec3SGrid>() ? 3 : 1) * sizeof(float);
    const auto memory = static_cast<int64_t>(grid.memUsage() + grid.baseTree().leafCount() * 512 * voxel_bytes);
    grid.insertMeta(GridBase::META_FILE_MEM_BYTES, Int64Metadata(memory));
    grid.insertMeta(GridBase::META_FILE_COMPRESSION, StringMetadata(io::compressionToString(compression)));
    grid.writeMeta(stream);
    grid.writeTransform(stream);
    grid.writeTopology(stream);
    std::streamoff end = position();
    descriptor.setBlockPos(end);
    for (const std::string_view piece : values) end += static_cast<std::streamoff>(piece.size());
    descriptor.setEndPos(end);

    stream.seekp(offsets);
    descriptor.writeStreamPos(stream);
}
}

std::vector<std::string_view> EncodedFog::pieces() const {
    std::vector<std::string_view> result;
    for (size_t g = 0; g < heads.size(); ++g) {
        result.push_back(heads[g]);
        result.insert(result.end(), leaves.grids[g].pieces.begin(), leaves.grids[g].pieces.end());
    }
    return result;
}

uint64_t EncodedFog::voxels() const {
    uint64_t sum = 0;
    for (const VoxelMask& mask : leaves.masks) sum += count_voxels(mask);
    return sum;
}

namespace {
openvdb::GridBase::Ptr empty_grid(const VdbGridContent& content, const dmat4& index_to_world,
                                  const VdbWriteOptions& options) {
    using namespace openvdb;
    const GridBase::Ptr grid = GridBase::createGrid(content.vector ? Vec3SGrid::gridType() : FloatGrid::gridType());
    grid->setName(content.name);
    if (content.vector)
        grid->setVectorType(VEC_CONTRAVARIANT_RELATIVE); // velocity
    else
        grid->setGridClass(GRID_FOG_VOLUME);
    grid->setCreator(options.creator);
    grid->setSaveFloatAsHalf(options.half);
    grid->setTransform(std::make_shared<math::Transform>(make_transform(index_to_world)));
    return grid;
}

// Everything of one grid before its leaf values; `before` bytes of other grids precede it.
std::string encode_head(const VdbContent& content, size_t number, uint64_t before, openvdb::GridBase& grid,
                        const EncodedFog& fog, const VdbWriteOptions& options, uint32_t packing) {
    std::ostringstream stream(std::ios::binary);
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    if (number == 0) write_head(stream, content.metadata, options.creator, content.grids.size());
    write_grid(stream, before, grid, openvdb::io::COMPRESS_ACTIVE_MASK | packing, fog.leaves.grids[number].pieces);
    return std::move(stream).str();
}
}

EncodedFog encode_fog(const VdbContent& content, const VdbWriteOptions& options, const std::string& where) {
    return with_library_errors(ExitCode::internal, where, [&] {
        using namespace openvdb;
        initialize();
        std::vector<GridBase::Ptr> grids;
        for (const VdbGridContent& grid : content.grids)
            grids.push_back(empty_grid(grid, content.index_to_world, options));
        const auto numbers = [&](size_t g) -> FloatTree& { return static_cast<FloatGrid&>(*grids[g]).tree(); };
        fill_tiles(numbers(0), content.tiles, options.half);

        // Encode the values first: their size is stored before them.
        const uint32_t packing = options.blosc ? io::COMPRESS_BLOSC : io::COMPRESS_ZIP;
        OrderedLeaves leaves = encode_in_order(content, leaves_of_tiles(numbers(0)), options.half, packing);
        EncodedFog fog{{}, std::move(leaves.encoded)};
        uint64_t before = 0;
        for (size_t g = 0; g < grids.size(); ++g) {
            if (content.grids[g].vector)
                add_leaves(static_cast<Vec3SGrid&>(*grids[g]).tree(), leaves.origins, fog.leaves.masks);
            else
                add_leaves(numbers(g), leaves.origins, fog.leaves.masks);
            fog.heads.push_back(encode_head(content, g, before, *grids[g], fog, options, packing));
            before += fog.heads.back().size();
            for (const std::string_view piece : fog.leaves.grids[g].pieces) before += piece.size();
            grids[g].reset();
        }

        // The UUID is a hash of the content, so equal content gives equal files.
        set_uuid(fog.heads[0], content_hash(fog.pieces()));
        return fog;
    });
}
}
