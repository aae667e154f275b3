#include "volume/vdb/vdb_fixtures.h"

#include <gtest/gtest.h>

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <random>
#include <sstream>
#include <unistd.h>

namespace tyndall::testing {
namespace {
openvdb::Coord coord(ivec3 at) { return {at.x, at.y, at.z}; }

template<class Value> Value as_value(float value) { return Value(value); }
template<> openvdb::Vec3i as_value(float value) { return openvdb::Vec3i(static_cast<int>(value)); }

openvdb::math::Transform::Ptr make_transform(const AuthoredGrid& grid) {
    if (grid.frustum)
        return openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {9, 9, 9}), 1, 1);
    openvdb::Mat4d rows;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) rows(i, j) = grid.index_to_world[i][j];
    return openvdb::math::Transform::createLinearTransform(rows);
}

// Grids come from the library's registry: making them here would compile every member of every type of tree.
template<class Grid> void fill(openvdb::GridBase& base, const AuthoredGrid& spec) {
    using Value = typename Grid::ValueType;
    auto& tree = static_cast<Grid&>(base).tree();
    if constexpr (!std::is_same_v<Grid, openvdb::MaskGrid>) {
        if (spec.background != 0) tree.root().setBackground(as_value<Value>(spec.background), true);
        for (const auto& [at, value] : spec.voxels) tree.setValueOn(coord(at), as_value<Value>(value));
        if constexpr (openvdb::VecTraits<Value>::IsVec)
            for (const auto& [at, value] : spec.colors) {
                using Number = typename openvdb::VecTraits<Value>::ElementType;
                tree.setValueOn(coord(at), Value(static_cast<Number>(value.x), static_cast<Number>(value.y),
                                                 static_cast<Number>(value.z)));
            }
    } else {
        for (const auto& voxel : spec.voxels) tree.setValueOn(coord(voxel.first));
    }
}

// Only densities have tiles and inactive values of their own.
template<class Grid> void fill_density(openvdb::GridBase& base, const AuthoredGrid& spec) {
    using Value = typename Grid::ValueType;
    fill<Grid>(base, spec);
    auto& tree = static_cast<Grid&>(base).tree();
    for (const AuthoredTile& tile : spec.tiles)
        tree.addTile(tile.level, coord(tile.at), Value(tile.value), tile.active);
    for (const auto& [at, value] : spec.inactive_voxels) tree.setValueOff(coord(at), Value(value));
}

openvdb::GridBase::Ptr make_grid(const AuthoredGrid& spec) {
    const std::vector<std::pair<std::string, void (*)(openvdb::GridBase&, const AuthoredGrid&)>> types = {
        {"float", fill_density<openvdb::FloatGrid>}, {"double", fill_density<openvdb::DoubleGrid>},
        {"int32", fill<openvdb::Int32Grid>},         {"int64", fill<openvdb::Int64Grid>},
        {"bool", fill<openvdb::BoolGrid>},           {"mask", fill<openvdb::MaskGrid>},
        {"vec3s", fill<openvdb::Vec3SGrid>},         {"vec3d", fill<openvdb::Vec3DGrid>},
        {"vec3i", fill<openvdb::Vec3IGrid>},
    };
    openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid("Tree_" + spec.type + "_5_4_3");
    for (const auto& [type, fill_grid] : types)
        if (type == spec.type) fill_grid(*grid, spec);
    return grid;
}

struct Writer : openvdb::io::Archive {
    using Archive::write;
};
}

std::string authored(const std::vector<AuthoredGrid>& specs, uint32_t packing, bool offsets) {
    openvdb::initialize();
    openvdb::GridPtrVec grids;
    for (const AuthoredGrid& spec : specs) {
        openvdb::GridBase::Ptr grid = make_grid(spec);
        if (spec.instance_of >= 0) grid->setTree(grids[static_cast<size_t>(spec.instance_of)]->baseTreePtr());
        grid->setName(spec.name);
        if (!spec.grid_class.empty()) grid->insertMeta("class", openvdb::StringMetadata(spec.grid_class));
        grid->setSaveFloatAsHalf(spec.half);
        grid->setTransform(make_transform(spec));
        grids.push_back(grid);
    }
    Writer writer;
    writer.setCompression(packing);
    std::ostringstream stream(std::ios::binary);
    openvdb::MetaMap metadata;
    metadata.insertMeta("origin", openvdb::StringMetadata("authored"));
    writer.write(stream, grids, offsets, metadata);
    return stream.str();
}

AuthoredGrid noisy_ball(ivec3 center, int radius, uint32_t seed) {
    AuthoredGrid grid;
    std::mt19937 random(seed);
    for (int x = -radius; x <= radius; ++x)
        for (int y = -radius; y <= radius; ++y)
            for (int z = -radius; z <= radius; ++z)
                if (x * x + y * y + z * z <= radius * radius)
                    grid.voxels.emplace_back(center + ivec3(x, y, z),
                                             0.1f + static_cast<float>(random() >> 8) * 0x1p-25f);
    return grid;
}

float value_at(const SparseVolume& volume, ivec3 voxel) {
    int found = 0;
    float value = 0;
    for (const Leaf& leaf : volume.leaves) {
        const ivec3 local = voxel - leaf.origin;
        if (glm::any(glm::lessThan(local, ivec3(0))) || glm::any(glm::greaterThan(local, ivec3(7)))) continue;
        ++found, value = leaf.values[static_cast<size_t>(local.x * 64 + local.y * 8 + local.z)];
    }
    for (const Tile& tile : volume.tiles)
        if (glm::all(glm::lessThanEqual(tile.low, voxel)) && glm::all(glm::lessThanEqual(voxel, tile.high)))
            ++found, value = tile.value;
    EXPECT_LE(found, 1);
    return value;
}

}
