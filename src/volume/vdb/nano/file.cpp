#include "volume/vdb/nano/file.h"

#include "base/error.h"
#include "base/text.h"
#include "volume/vdb/choose.h"
#include "volume/vdb/file/transform.h"

#include <blosc.h>
#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/IO.h>
#include <zlib.h>

#include <cstring>

namespace tyndall {
namespace {
constexpr std::string_view magic = "NanoVDB"; // followed by a digit that distinguishes files from grids
constexpr uint32_t readable_version = 32;     // major version; minor versions are compatible
constexpr uint64_t max_name = 4096, max_grids = 1024;
constexpr uint64_t max_expansion = 1100; // upper bound on the compression ratio of zlib and LZ4

bool has_magic(const void* bytes) { return std::memcmp(bytes, magic.data(), magic.size()) == 0; }

// OpenVDB names of grid types; quantized floats count as float.
std::string type_name(nanovdb::GridType type) {
    using enum nanovdb::GridType;
    if (type == Fp4 || type == Fp8 || type == Fp16 || type == FpN) return "float";
    if (type == Vec3f) return "vec3s";
    if (type == Vec3d) return "vec3d";
    return type < End ? nanovdb::toStr(type) : "unknown";
}

std::string class_name(nanovdb::GridClass grid_class) {
    using enum nanovdb::GridClass;
    if (grid_class == FogVolume) return "fog volume";
    if (grid_class == LevelSet) return "level set";
    return grid_class == Staggered ? "staggered" : "unknown";
}

uint32_t compression_of(nanovdb::io::Codec codec, const ByteCursor& file) {
    using enum nanovdb::io::Codec;
    if (codec == ZIP) return vdb_zip;
    if (codec == BLOSC) return vdb_blosc;
    if (codec != NONE) file.complain("its compression is unknown: " + std::to_string(static_cast<int>(codec)));
    return 0;
}

// Decompresses one chunk to at most `size` bytes; returns the number of bytes.
uint64_t unpack_zip(std::string_view packed, char* to, uint64_t size, const ByteCursor& file) {
    z_stream stream{};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
    int state = Z_OK;
    uint64_t taken = 0, made = 0;
    constexpr uint64_t step = 1 << 30; // zlib counts are 32-bit
    while (state == Z_OK && made < size) {
        stream.avail_in = static_cast<uInt>(std::min(packed.size() - taken, step));
        stream.next_out = reinterpret_cast<Bytef*>(to + made);
        stream.avail_out = static_cast<uInt>(std::min(size - made, step));
        const uInt in = stream.avail_in, out = stream.avail_out;
        state = inflate(&stream, Z_NO_FLUSH);
        taken += in - stream.avail_in, made += out - stream.avail_out;
        if (in == stream.avail_in && out == stream.avail_out) break;
    }
    inflateEnd(&stream);
    if (state != Z_OK && state != Z_STREAM_END) file.complain("its ZIP data is damaged");
    return made;
}

uint64_t unpack_blosc(std::string_view packed, char* to, uint64_t size, const ByteCursor& file) {
    size_t whole = 0;
    if (blosc_cbuffer_validate(packed.data(), packed.size(), &whole) != 0 || whole == 0)
        file.complain("its Blosc data is damaged");
    size_t item = 0;
    int flags = 0;
    blosc_cbuffer_metainfo(packed.data(), &item, &flags);
    const int made = whole <= size ? blosc_decompress_ctx(packed.data(), to, size, 1)
                     : item > 0    ? blosc_getitem(packed.data(), 0, static_cast<int>(size / item), to)
                                   : -1;
    if (made <= 0) file.complain("its Blosc data is damaged");
    return static_cast<uint64_t>(made);
}

// Reads the first `size` bytes of a grid, decompressed.
void unpack(ByteCursor& file, const VdbGridEntry& grid, char* to, uint64_t size) {
    file.seek(grid.tree_begin, "the grid");
    if (grid.compression == 0) return file.read(to, size, "the grid");
    for (uint64_t made = 0; made < size;) {
        if (grid.tree_end - file.position() < sizeof(uint64_t)) file.complain("its compressed data ends early");
        const auto packed_size = file.value<uint64_t>("the length of compressed data");
        if (packed_size == 0 || packed_size > grid.tree_end - file.position())
            file.complain("compressed data has an invalid length of " + std::to_string(packed_size));
        const std::string packed = file.bytes(packed_size, "compressed data");
        const auto unpack_chunk = grid.compression == vdb_zip ? unpack_zip : unpack_blosc;
        const uint64_t more = unpack_chunk(packed, to + made, size - made, file);
        if (more == 0) file.complain("a block of compressed data is empty");
        made += more;
    }
}

dmat4 matrix_of(const nanovdb::Map& map) {
    dmat4 matrix(1);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) matrix[column][row] = map.mMatD[3 * row + column];
        matrix[3][row] = map.mVecD[row];
    }
    return matrix;
}

void check_version(const nanovdb::Version& version, const ByteCursor& file) {
    if (version.getMajor() == readable_version) return;
    file.complain(formatted("is NanoVDB %u.%u; only version %u is supported", version.getMajor(), version.getMinor(),
                            readable_version));
}

// Reads the grid's own header, which must agree with the file's description of the grid.
void read_head(ByteCursor& file, const nanovdb::io::MetaData& announced, VdbGridEntry& grid) {
    nanovdb::GridData head;
    unpack(file, grid, reinterpret_cast<char*>(&head), sizeof head);
    if (!has_magic(&head)) file.complain("its header is damaged");
    check_version(head.mVersion, file);
    if (head.mGridSize != grid.nano_bytes || head.mGridType != announced.gridType)
        file.complain("its header contradicts the file's description of it");
    grid.grid_class = class_name(head.mGridClass);
    grid.index_to_world = matrix_of(head.mMap);
    grid.transform_problem = matrix_problem(grid.index_to_world);
}

VdbGridEntry read_announcement(ByteCursor& file, nanovdb::io::MetaData& announced, uint32_t compression) {
    file.read(&announced, sizeof announced, "the description of a grid");
    VdbGridEntry grid;
    if (announced.nameSize > max_name)
        file.complain("a grid's name has an invalid length of " + std::to_string(announced.nameSize));
    const std::string name = file.bytes(announced.nameSize, "the name of a grid");
    grid.name = grid.unique_name = name.substr(0, name.find('\0'));
    grid.type = type_name(announced.gridType);
    if (grid.type == "float" || grid.type == "double" || grid.type.starts_with("vec3")) grid.tree_shape = "5_4_3";
    if (announced.gridType >= nanovdb::GridType::Fp4 && announced.gridType <= nanovdb::GridType::FpN)
        grid.metadata.emplace_back("stored_as", nanovdb::toStr(announced.gridType));
    grid.compression = compression;
    for (int axis = 0; axis < 3; ++axis)
        grid.stated_low[axis] = announced.indexBBox.min()[axis],
        grid.stated_high[axis] = announced.indexBBox.max()[axis];
    grid.nano_type = static_cast<uint32_t>(announced.gridType), grid.nano_bytes = announced.gridSize;
    return grid;
}

// Reads a file segment: its header, the grid descriptions and the grids' headers.
void read_segment(ByteCursor& file, VdbDirectory& directory) {
    const auto header = file.value<nanovdb::io::Header>("the header");
    if (!has_magic(&header)) file.complain("is damaged: no grids start here");
    check_version(header.version, file);
    directory.library_major = header.version.getMajor(), directory.library_minor = header.version.getMinor();
    const uint32_t compression = compression_of(header.codec, file);
    if (header.gridCount == 0 || directory.grids.size() + header.gridCount > max_grids)
        file.complain("claims " + std::to_string(header.gridCount) + " grids");

    std::vector<nanovdb::io::MetaData> announced(header.gridCount);
    const size_t first = directory.grids.size();
    for (nanovdb::io::MetaData& one : announced) directory.grids.push_back(read_announcement(file, one, compression));

    const std::string where = file.where;
    for (size_t n = 0; n < announced.size(); ++n) {
        VdbGridEntry& grid = directory.grids[first + n];
        file.where = label(file, grid);
        grid.tree_begin = file.position();
        const uint64_t size = announced[n].fileSize, most = compression ? size * max_expansion : size;
        if (size > file.left()) file.complain("is truncated: the grid takes " + std::to_string(size) + " bytes");
        if (grid.nano_bytes < sizeof(nanovdb::GridData) || grid.nano_bytes > most || size > (uint64_t{1} << 50))
            file.complain("claims a grid of " + std::to_string(grid.nano_bytes) + " bytes stored in " +
                          std::to_string(size));
        grid.tree_end = grid.tree_begin + size;
        read_head(file, announced[n], grid);
        file.seek(grid.tree_end, "the end of the grid");
        file.where = where;
    }
}
}

bool is_nanovdb(ByteCursor& file) {
    char start[magic.size()] = {};
    if (file.left() < sizeof start) return false;
    const uint64_t here = file.position();
    file.read(start, sizeof start, "the header");
    file.seek(here, "the header");
    return has_magic(start);
}

VdbDirectory read_nano_directory(ByteCursor& file) {
    VdbDirectory directory;
    directory.nano = true;
    while (file.left() > 0) read_segment(file, directory);
    return directory;
}

LargeBytes unpacked_grid(ByteCursor& file, const VdbGridEntry& grid) {
    LargeBytes bytes = large_bytes(grid.nano_bytes);
    unpack(file, grid, bytes.get(), grid.nano_bytes);
    return bytes;
}
}
