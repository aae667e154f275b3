#include "volume/vdb_codec.h"

#include "base/error.h"
#include "base/file.h"
#include "base/parallel.h"

#include <openvdb/Grid.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <new>
#include <optional>
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

constexpr size_t most_tiles = size_t{1} << 26; // a few bytes in a file can stand for thousands of them

ivec3 point(const openvdb::Coord& coord) { return {coord.x(), coord.y(), coord.z()}; }

// The one value tells active from inactive, whatever the level of the tile.
template<class Iterator> void append_tile(const Iterator& at, bool active, DecodedTree& result) {
    const openvdb::CoordBBox box = at.getBoundingBox();
    const Tile tile{point(box.min()), point(box.max()), static_cast<float>(at.getValue())};
    if (active)
        result.active_tiles.push_back(tile);
    else if (tile.value != 0)
        result.inactive_tiles.push_back(tile);
}

template<class Tree> void append_tiles(const Tree& tree, DecodedTree& result) {
    auto on = tree.cbeginValueOn();
    on.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; on; ++on) append_tile(on, true, result);
    auto off = tree.cbeginValueOff();
    off.setMaxDepth(Tree::ValueOffCIter::LEAF_DEPTH - 1);
    for (; off; ++off) append_tile(off, false, result);
}

template<class Tree> void append_leaves(const Tree& tree, DecodedTree& result) {
    std::vector<const typename Tree::LeafNodeType*> nodes;
    nodes.reserve(tree.leafCount());
    tree.getNodes(nodes);
    result.leaves.resize(nodes.size());
    result.active.resize(nodes.size());
    parallel_ranges(static_cast<int64_t>(nodes.size()), 256, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const auto n = static_cast<size_t>(i);
            const auto& node = *nodes[n];
            result.leaves[n].origin = point(node.origin());
            const auto* values = node.buffer().data();
            for (size_t v = 0; v < 512; ++v) result.leaves[n].values[v] = static_cast<float>(values[v]);
            for (openvdb::Index w = 0; w < 8; ++w)
                result.active[n][w] = node.valueMask().template getWord<openvdb::Index64>(w);
        }
    });
}

// The tree is read from a stream that throws and has no file behind it, so nothing is mapped or loaded late.
// Grids come from the library's registry: making them here would compile every member of every type of tree.
template<class Grid> DecodedTree decoded(std::string bytes, const VdbGridEntry& entry, uint32_t file_version) {
    openvdb::initialize();
    const openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid("Tree_" + entry.type + "_5_4_3");
    {
        const auto size = static_cast<std::streamoff>(bytes.size());
        std::istringstream stream(std::move(bytes), std::ios::binary);
        stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
        openvdb::io::setVersion(stream, openvdb::VersionId(0, 0), file_version);
        openvdb::io::setDataCompression(stream, entry.compression);
        grid->setSaveFloatAsHalf(entry.half);
        grid->readTopology(stream);
        grid->readBuffers(stream);
        if (stream.tellg() != size) throw std::runtime_error("the tree ends before its bytes do");
    }
    const auto& tree = static_cast<const Grid&>(*grid).tree();
    DecodedTree result;
    result.background = static_cast<float>(tree.background());
    for (auto at = tree.root().cbeginChildAll(); at; ++at) result.root_nodes.push_back(point(at.getCoord()));
    append_tiles(tree, result);
    append_leaves(tree, result);
    return result;
}

// The value a reader will see: what half cannot hold is clamped, what it rounds to nothing is nothing.
float stored_value(float value, bool half) {
    if (!(value > 0)) return 0;
    if (!half) return std::min(value, std::numeric_limits<float>::max());
    return static_cast<float>(openvdb::math::half(std::min(value, 65504.0f)));
}

void fill_tree(openvdb::FloatTree& tree, const SparseVolume& volume, bool half) {
    for (const Tile& tile : volume.tiles) {
        const float value = stored_value(tile.value, half);
        if (value == 0) continue;
        const openvdb::Coord low(tile.low.x, tile.low.y, tile.low.z), high(tile.high.x, tile.high.y, tile.high.z);
        tree.sparseFill(openvdb::CoordBBox(low, high), value, true);
    }
    for (const Leaf& leaf : volume.leaves) {
        assert((leaf.origin.x & 7) == 0 && (leaf.origin.y & 7) == 0 && (leaf.origin.z & 7) == 0);
        std::array<float, 512> values;
        for (size_t v = 0; v < 512; ++v) values[v] = stored_value(leaf.values[v], half);
        if (std::all_of(values.begin(), values.end(), [](float value) { return value == 0; })) continue;
        auto* node = tree.touchLeaf(openvdb::Coord(leaf.origin.x, leaf.origin.y, leaf.origin.z));
        for (openvdb::Index v = 0; v < 512; ++v)
            if (values[v] != 0) node->setValueOn(v, values[v]);
    }
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

std::optional<double> number(const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return value;
}

// Text, but for the keys that readers take as numbers (the library's text for a double reads back the same).
openvdb::MetaMap make_metadata(const SparseVolume& volume, const std::string& creator) {
    constexpr std::string_view whole[] = {"tyndall_schema", "tyndall_seed"};
    constexpr std::string_view real[] = {"tyndall_frame",  "tyndall_time_s",           "tyndall_fps",
                                         "tyndall_unit_m", "tyndall_extinction_per_m", "tyndall_g"};
    openvdb::MetaMap metadata;
    for (const auto& [key, text] : volume.metadata) {
        if (key.empty() || key == "creator") continue;
        metadata.removeMeta(key);
        const std::optional<double> value = number(text);
        const auto is_key = [&](std::string_view name) { return name == key; };
        if (value && std::ranges::any_of(whole, is_key) && *value == std::floor(*value) && std::abs(*value) < 1e15)
            metadata.insertMeta(key, openvdb::Int64Metadata(static_cast<int64_t>(*value)));
        else if (value && std::ranges::any_of(real, is_key))
            metadata.insertMeta(key, openvdb::DoubleMetadata(*value));
        else
            metadata.insertMeta(key, openvdb::StringMetadata(text));
    }
    metadata.insertMeta("creator", openvdb::StringMetadata(creator));
    return metadata;
}

template<class T> void write_value(std::ostream& stream, T value) {
    stream.write(reinterpret_cast<const char*>(&value), sizeof value);
}

// Where the 36 characters of the UUID stand; the library would fill them at random.
constexpr size_t uuid_begin = 21, uuid_bytes = 36;

void write_header(std::ostream& stream) {
    write_value<int64_t>(stream, openvdb::OPENVDB_MAGIC);
    write_value<uint32_t>(stream, openvdb::OPENVDB_FILE_VERSION);
    write_value<uint32_t>(stream, openvdb::OPENVDB_LIBRARY_MAJOR_VERSION);
    write_value<uint32_t>(stream, openvdb::OPENVDB_LIBRARY_MINOR_VERSION);
    write_value<char>(stream, 1); // the grids say where they begin and end
    stream << "00000000-0000-0000-0000-000000000000";
}

// As the library lays a grid out, but with ZIP when asked for: it never packs a fog volume so.
void write_grid(std::ostream& stream, openvdb::GridBase& grid, bool blosc) {
    using namespace openvdb;
    const uint32_t compression = io::COMPRESS_ACTIVE_MASK | (blosc ? io::COMPRESS_BLOSC : io::COMPRESS_ZIP);
    io::GridDescriptor descriptor(grid.getName(), grid.type(), grid.saveFloatAsHalf());
    descriptor.writeHeader(stream);
    const std::streampos offsets = stream.tellp();
    descriptor.writeStreamPos(stream);

    descriptor.setGridPos(stream.tellp());
    io::setDataCompression(stream, compression);
    write_value(stream, compression);
    grid.addStatsMetadata();
    grid.insertMeta(GridBase::META_FILE_COMPRESSION, StringMetadata(io::compressionToString(compression)));
    grid.writeMeta(stream);
    grid.writeTransform(stream);
    grid.writeTopology(stream);
    descriptor.setBlockPos(stream.tellp());
    grid.writeBuffers(stream);
    descriptor.setEndPos(stream.tellp());

    stream.seekp(offsets);
    descriptor.writeStreamPos(stream);
}
}

DecodedTree decode_tree(std::string bytes, const VdbGridEntry& grid, uint32_t file_version, const std::string& where) {
    return guarded(ExitCode::refused, where, [&] {
        return grid.type == "double" ? decoded<openvdb::DoubleGrid>(std::move(bytes), grid, file_version)
                                     : decoded<openvdb::FloatGrid>(std::move(bytes), grid, file_version);
    });
}

std::string encode_fog(const SparseVolume& volume, const VdbWriteOptions& options, const std::string& where) {
    return guarded(ExitCode::internal, where, [&] {
        openvdb::initialize();
        const openvdb::GridBase::Ptr base = openvdb::GridBase::createGrid(openvdb::FloatGrid::gridType());
        auto& grid = static_cast<openvdb::FloatGrid&>(*base);
        fill_tree(grid.tree(), volume, options.half);
        grid.setName(volume.name);
        grid.setGridClass(openvdb::GRID_FOG_VOLUME);
        grid.setCreator(options.creator);
        grid.setSaveFloatAsHalf(options.half);
        grid.setTransform(std::make_shared<openvdb::math::Transform>(make_transform(volume.index_to_world)));

        std::ostringstream stream(std::ios::binary);
        stream.exceptions(std::ios::failbit | std::ios::badbit);
        write_header(stream);
        make_metadata(volume, options.creator).writeMeta(stream);
        write_value<int32_t>(stream, 1);
        write_grid(stream, grid, options.blosc);

        // The same content gets the same identity.
        std::string bytes = std::move(stream).str(), hash = content_hash(bytes);
        for (const size_t hyphen : {8, 13, 18, 23}) hash.insert(hyphen, "-");
        return bytes.replace(uuid_begin, uuid_bytes, hash);
    });
}
}
