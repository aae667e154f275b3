// Hostile and cut files: every one is refused by place, and none reaches the library.
#include "volume/vdb/file/prewalk.h"
#include "volume/vdb/vdb.h"
#include "volume/vdb/vdb_fixtures.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace tyndall {
namespace {
using namespace testing;
using ::testing::AnyOf;
using ::testing::HasSubstr;

template<class T> T value_of(const std::string& bytes, size_t position) {
    T value;
    std::memcpy(&value, bytes.data() + position, sizeof value);
    return value;
}

// Where the fields of a file with one grid of a single leaf stand.
struct Anatomy {
    size_t metadata_count = 57, grid_count, name, type, parent, offsets, compression, grid_metadata_count, map;
    size_t tree, background, tiles, nodes, key, upper_children, upper_values, upper_kind, upper_chunk;
    size_t lower_children, lower_kind, lower_chunk, leaf_mask, voxel_mask, leaf_kind, leaf_chunk;
};

size_t after_text(const std::string& bytes, size_t position) {
    return position + 4 + value_of<uint32_t>(bytes, position);
}

size_t after_metadata(const std::string& bytes, size_t position) {
    const auto count = value_of<uint32_t>(bytes, position);
    position += 4;
    for (uint32_t i = 0; i < count; ++i) position = after_text(bytes, after_text(bytes, after_text(bytes, position)));
    return position;
}

size_t after_chunk(const std::string& bytes, size_t position, bool packed, size_t raw) {
    if (!packed) return position + raw;
    const auto length = value_of<int64_t>(bytes, position);
    return position + 8 + static_cast<size_t>(length < 0 ? -length : length);
}

Anatomy dissect(const std::string& bytes) {
    Anatomy a{};
    a.metadata_count = 57;
    a.grid_count = after_metadata(bytes, a.metadata_count);
    a.name = a.grid_count + 4;
    a.type = after_text(bytes, a.name);
    a.parent = after_text(bytes, a.type);
    a.offsets = after_text(bytes, a.parent);
    a.compression = a.offsets + 24;
    a.grid_metadata_count = a.compression + 4;
    a.map = after_metadata(bytes, a.grid_metadata_count);
    const auto flags = value_of<uint32_t>(bytes, a.compression);
    const bool packed = flags & (pack_zip | pack_blosc), active_only = flags & pack_mask;
    a.tree = after_text(bytes, a.map) + 5 * 3 * sizeof(double); // a map of scales only
    a.background = a.tree + 4, a.tiles = a.tree + 8, a.nodes = a.tree + 12, a.key = a.tree + 16;
    a.upper_children = a.key + 12, a.upper_values = a.upper_children + 4096;
    a.upper_kind = a.upper_values + 4096, a.upper_chunk = a.upper_kind + 1;
    a.lower_children = after_chunk(bytes, a.upper_chunk, packed, active_only ? 0 : 32768 * 4);
    a.lower_kind = a.lower_children + 1024, a.lower_chunk = a.lower_kind + 1;
    a.leaf_mask = after_chunk(bytes, a.lower_chunk, packed, active_only ? 0 : 4096 * 4);
    a.voxel_mask = a.leaf_mask + 64, a.leaf_kind = a.voxel_mask + 64, a.leaf_chunk = a.leaf_kind + 1;
    return a;
}

AuthoredGrid one_leaf() {
    AuthoredGrid grid = noisy_ball(ivec3(3), 3);
    grid.index_to_world = glm::scale(dmat4(1), dvec3(0.5));
    return grid;
}

Error refusal(const std::string& bytes) {
    const TempFolder scratch;
    const auto file = scratch.put("in.vdb", bytes);
    const Error info = error_of([&] { vdb_info(file); });
    const Error read = error_of([&] { read_vdb(file); });
    EXPECT_TRUE(info.code == ExitCode::ok || info.code == ExitCode::refused) << info.what();
    EXPECT_LE(std::strlen(read.what()), 500u);
    return read;
}

#define EXPECT_REFUSED(bytes, text)                                                                                    \
    do {                                                                                                               \
        const Error error = refusal(bytes);                                                                            \
        EXPECT_EQ(error.code, ExitCode::refused);                                                                      \
        EXPECT_THAT(error.what(), HasSubstr(text));                                                                    \
    } while (false)

// A fixed set of bytes for each way to pack values.
class Hostile : public ::testing::TestWithParam<uint32_t> {
protected:
    const std::string good = authored({one_leaf()}, GetParam());
    const Anatomy at = dissect(good);
};

TEST_P(Hostile, TheFileItselfIsGood) {
    ByteCursor cursor("in.vdb", good, 0);
    const VdbDirectory directory = read_directory(cursor);
    ASSERT_EQ(directory.grids.size(), 1u);
    EXPECT_EQ(directory.grids[0].tree_begin, at.tree);
    EXPECT_EQ(directory.grids[0].tree_end, good.size());
    EXPECT_EQ(directory.grids[0].compression, GetParam());
    cursor.seek(at.tree, "");
    const VdbTreeCounts counts = walk_tree(cursor, directory.grids[0]);
    EXPECT_EQ(counts.leaves, 1u);
    EXPECT_EQ(counts.lower_nodes, 1u);
    EXPECT_EQ(counts.upper_nodes, 1u);
    EXPECT_EQ(counts.active_voxels, one_leaf().voxels.size());
    EXPECT_EQ(cursor.left(), 0u);
}

TEST_P(Hostile, Header) {
    EXPECT_REFUSED(patched(good, 0, 'x'), "neither an OpenVDB nor a NanoVDB file");
    for (const uint32_t version : {0u, 100u, 221u, 226u, 999u})
        EXPECT_REFUSED(patched(good, 8, version), "file version");
    EXPECT_REFUSED(patched(good, 20, uint8_t{2}), "header");
    for (const uint32_t count : {4097u, 0x7fffffffu, 0xffffffffu}) {
        EXPECT_REFUSED(patched(good, at.metadata_count, count), "metadata");
        EXPECT_REFUSED(patched(good, at.grid_metadata_count, count), "metadata");
    }
    EXPECT_REFUSED(patched(good, at.grid_count, 0), "no grids");
    for (const int32_t count : {-1, 1025, INT32_MIN, INT32_MAX})
        EXPECT_REFUSED(patched(good, at.grid_count, count), "grids");
}

TEST_P(Hostile, LengthsOfTexts) {
    const size_t metadata_name = at.metadata_count + 4, metadata_type = after_text(good, metadata_name);
    for (const size_t place : {at.name, at.type, at.parent, at.map, metadata_name, metadata_type,
                               after_text(good, metadata_type), at.grid_metadata_count + 4})
        for (const uint32_t length : {5000u, 0x7fffffffu, 0xfffffff0u})
            EXPECT_EQ(refusal(patched(good, place, length)).code, ExitCode::refused) << place << ' ' << length;
}

TEST_P(Hostile, Offsets) {
    for (const size_t place : {at.offsets, at.offsets + 8, at.offsets + 16})
        for (const int64_t offset : {int64_t{-1}, int64_t{0}, int64_t{1} << 40, INT64_MAX, INT64_MIN})
            EXPECT_EQ(refusal(patched(good, place, offset)).code, ExitCode::refused) << place << ' ' << offset;
    EXPECT_REFUSED(patched(good, at.offsets + 16, static_cast<int64_t>(good.size() + 1)), "is truncated");
    const auto here = static_cast<int64_t>(at.tree - 1);
    EXPECT_REFUSED(patched(patched(good, at.offsets + 8, here), at.offsets + 16, here), "extends past its end");
}

TEST_P(Hostile, CountsOfTheTree) {
    EXPECT_REFUSED(patched(good, at.tree, 2), "buffer");
    for (const uint32_t count : {2u, 0x10000u, 0xffffffffu}) {
        EXPECT_EQ(refusal(patched(good, at.tiles, count)).code, ExitCode::refused);
        EXPECT_EQ(refusal(patched(good, at.nodes, count)).code, ExitCode::refused);
    }
}

TEST_P(Hostile, PlacesOfRootNodes) {
    EXPECT_REFUSED(patched(good, at.key, 1), "multiple of 4096");
    EXPECT_REFUSED(patched(good, at.key + 4, -8), "multiple of 4096");
    EXPECT_REFUSED(patched(good, at.key + 8, 1 << 24), "2^24");
    EXPECT_REFUSED(patched(good, at.key + 8, INT32_MIN), "2^24");

    AuthoredGrid two = one_leaf();
    two.voxels.emplace_back(ivec3(0, 0, 4096), 1.0f);
    const std::string bytes = authored({two}, GetParam());
    const size_t key = dissect(bytes).key;
    EXPECT_REFUSED(patched(bytes, key + 8, 4096), "not in order");
    EXPECT_REFUSED(patched(bytes, key + 8, 8192), "not in order");
    two.tiles = {{ivec3(0, 0, 8192), 3, 1.0f}};
    const std::string tiled = authored({two}, GetParam());
    EXPECT_REFUSED(patched(tiled, dissect(tiled).key + 8, 0), "duplicate root node"); // tiles come first
}

TEST_P(Hostile, NodesThatContradictThemselves) {
    const auto child = value_of<uint64_t>(good, at.upper_children);
    ASSERT_NE(child, 0u);
    EXPECT_REFUSED(patched(good, at.upper_values, child), "a child and a value");
    EXPECT_REFUSED(patched(good, at.lower_children + 512, value_of<uint64_t>(good, at.lower_children)),
                   "a child and a value");
    for (const size_t place : {at.upper_kind, at.lower_kind, at.leaf_kind})
        for (const int8_t kind : {int8_t{-1}, int8_t{7}, int8_t{127}})
            EXPECT_REFUSED(patched(good, place, kind), "kind");
    EXPECT_EQ(refusal(patched(good, at.leaf_mask, ~value_of<uint64_t>(good, at.leaf_mask))).code, ExitCode::refused);
    EXPECT_EQ(refusal(patched(good, at.voxel_mask, ~value_of<uint64_t>(good, at.voxel_mask))).code, ExitCode::refused);
    EXPECT_REFUSED(patched(good, at.compression, 8u), "compression");
}

INSTANTIATE_TEST_SUITE_P(Packings, Hostile,
                         ::testing::Values(pack_none, pack_mask, pack_zip, pack_mask | pack_zip, pack_blosc,
                                           pack_mask | pack_blosc));

TEST(Prewalk, LengthsOfChunks) {
    for (const uint32_t packing : {pack_zip, pack_mask | pack_zip, pack_blosc, pack_mask | pack_blosc}) {
        const std::string good = authored({one_leaf()}, packing);
        const Anatomy at = dissect(good);
        for (const size_t place : {at.upper_chunk, at.lower_chunk, at.leaf_chunk})
            for (const int64_t length :
                 {int64_t{-1}, int64_t{-4096}, int64_t{1} << 40, int64_t{8} << 30, INT64_MIN, INT64_MAX})
                EXPECT_EQ(refusal(patched(good, place, length)).code, ExitCode::refused) << place << ' ' << length;
        EXPECT_REFUSED(patched(good, at.leaf_chunk, int64_t{-1}), "a chunk of");
    }
}

TEST(Prewalk, BloscHeaders) {
    for (const uint32_t packing : {pack_blosc, pack_mask | pack_blosc}) {
        const std::string good = authored({one_leaf()}, packing);
        const size_t chunk = dissect(good).leaf_chunk;
        ASSERT_GT(value_of<int64_t>(good, chunk), 16);
        for (const size_t field : {4, 8, 12}) // plain size, block size, packed size
            for (const uint32_t size : {0u, 1u << 20, 0xffffffffu})
                EXPECT_REFUSED(patched(good, chunk + 8 + field, size), "has the wrong size");
        for (const uint8_t flags : {0x02, 0x08, 0xff})
            EXPECT_EQ(refusal(patched(good, chunk + 8 + 2, flags)).code, ExitCode::refused);
    }
}

TEST(Prewalk, Transforms) {
    const std::string good = authored({one_leaf()});
    const size_t scale = after_text(good, dissect(good).map);
    const double nan = std::nan(""), infinite = HUGE_VAL;
    for (const double value : {nan, infinite, -infinite}) EXPECT_REFUSED(patched(good, scale, value), "not finite");
    EXPECT_REFUSED(patched(good, scale, 0.0), "singular");
    EXPECT_REFUSED(patched(good, scale, 0.75), "is inconsistent");           // the scale alone
    EXPECT_REFUSED(patched(good, scale + 48, nan), "is inconsistent");       // what is derived from it alone
    EXPECT_REFUSED(patched(good, dissect(good).map + 4, 'X'), "is unknown"); // the kind of map

    AuthoredGrid sheared = one_leaf();
    sheared.index_to_world[1][0] = 0.25;
    const std::string affine = authored({sheared});
    const size_t matrix = after_text(affine, dissect(affine).map);
    EXPECT_REFUSED(patched(affine, matrix + 8, nan), "not finite");
    EXPECT_REFUSED(patched(affine, matrix + 24, 1.0), "projection");
    EXPECT_REFUSED(patched(affine, matrix + 96, 1e30), "inverted");
    EXPECT_REFUSED(patched(patched(affine, matrix, 0.25), matrix + 8, 0.5), "singular");
}

// The library sizes buffers by what this item says; here its content is passed by unseen.
TEST(Prewalk, DelayedLoadMetadataIsNotBelieved) {
    const std::string good = authored({noisy_ball(ivec3(3), 12)});
    const size_t name = good.find("__delayedload");
    ASSERT_NE(name, std::string::npos);
    const size_t size = name + 13;
    ASSERT_GT(value_of<uint32_t>(good, size), 8u);
    const TempFolder scratch;
    const SparseVolume plain = read_vdb(scratch.put("a.vdb", good));
    const SparseVolume volume = read_vdb(scratch.put("b.vdb", patched(patched(good, size + 4, ~0u), size + 8, ~0u)));
    EXPECT_EQ(value_at(volume, ivec3(3)), value_at(plain, ivec3(3)));
    EXPECT_REFUSED(patched(good, size, ~0u), "is truncated");
}

TEST(Prewalk, HalfIsToldTwice) {
    AuthoredGrid grid = one_leaf();
    grid.half = true;
    const std::string good = authored({grid});
    const size_t flag = good.find("is_saved_as_half_float") + 22 + 4 + 4 + 4;
    ASSERT_EQ(good[flag], 1);
    EXPECT_REFUSED(patched(good, flag, char{0}), "half");
}

TEST(Prewalk, ActiveStateOfRootTiles) {
    AuthoredGrid grid;
    grid.tiles = {{ivec3(0), 3, 0.5f}};
    const std::string good = authored({grid});
    EXPECT_EQ(refusal(good).code, ExitCode::ok);
    EXPECT_REFUSED(patched(good, good.size() - 1, char{2}), "root tile");
}

TEST(Prewalk, InstanceOfNothing) {
    AuthoredGrid first = one_leaf(), second = one_leaf();
    second.name = "copy", second.instance_of = 0;
    std::string bytes = authored({first, second});
    const size_t parent = bytes.rfind("density", bytes.size());
    ASSERT_NE(parent, std::string::npos);
    EXPECT_REFUSED(bytes.replace(bytes.find("density", bytes.find("copy")), 7, "densitx"), "that is missing");
    EXPECT_REFUSED(bytes.replace(bytes.find("densitx"), 7, std::string("copy\0\0\0", 7)), "that is missing");
}

TEST(Prewalk, NamesCannotBreakTheMessage) {
    AuthoredGrid grid = one_leaf();
    grid.name = "a\n\x1b[31m" + std::string(4000, 'x'), grid.type = "vec3s";
    const Error error = refusal(authored({grid}));
    EXPECT_EQ(error.code, ExitCode::refused);
    for (const char c : std::string(error.what())) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
}

// Cut anywhere, packed in any way, with or without offsets: never loaded.
class Cut : public ::testing::TestWithParam<std::tuple<uint32_t, bool, bool>> {};

TEST_P(Cut, IsAlwaysRefused) {
    const auto [packing, half, offsets] = GetParam();
    AuthoredGrid ball = noisy_ball({3, 0, 4094}, 9), second = noisy_ball(ivec3(0), 5);
    ball.half = second.half = half, second.name = "heat";
    const std::string good = authored({ball, second}, packing, offsets);
    const TempFolder scratch;
    EXPECT_NO_THROW(read_vdb(scratch.put("good.vdb", good)));
    std::vector<size_t> lengths = {good.size() - 1, good.size() - 2, 0, 1, 8, 20, 57, 60};
    for (size_t i = 1; i < 60; ++i) lengths.push_back(good.size() * i / 60 + i % 7);
    for (const size_t length : lengths) {
        const auto file = scratch.put("cut.vdb", good.substr(0, length));
        const Error read = error_of([&] { read_vdb(file); });
        EXPECT_EQ(read.code, ExitCode::refused) << "cut to " << length << " of " << good.size();
        EXPECT_EQ(error_of([&] { vdb_metadata(file); }).code, ExitCode::refused) << length;
        EXPECT_THAT(read.what(), AnyOf(HasSubstr("cut"), HasSubstr("neither an OpenVDB nor a NanoVDB file")));
    }
}

INSTANTIATE_TEST_SUITE_P(Packings, Cut,
                         ::testing::Combine(::testing::Values(pack_none, pack_mask, pack_mask | pack_zip, pack_blosc,
                                                              pack_mask | pack_blosc),
                                            ::testing::Bool(), ::testing::Bool()));
}
}
