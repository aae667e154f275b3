#include "volume/vdb/nano/fixtures.h"

#include "base/io/file.h"
#include "support/scratch.h"

#define NANOVDB_USE_ZIP
#define NANOVDB_USE_BLOSC
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/io/Stream.h>

#include <sstream>

namespace tyndall::testing {
namespace {
nanovdb::GridHandle<> converted(const openvdb::GridBase::Ptr& grid, NanoStore store) {
    if (store == NanoStore::plain) return nanovdb::openToNanoVDB(grid);
    const auto& floats = static_cast<const openvdb::FloatGrid&>(*grid);
    const auto as = [&]<class Build>(std::type_identity<Build>) {
        return nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, Build>(floats);
    };
    if (store == NanoStore::fp4) return as(std::type_identity<nanovdb::Fp4>());
    if (store == NanoStore::fp8) return as(std::type_identity<nanovdb::Fp8>());
    if (store == NanoStore::fp16) return as(std::type_identity<nanovdb::Fp16>());
    return as(std::type_identity<nanovdb::FpN>());
}
}

std::string nano_authored(const std::vector<AuthoredGrid>& specs, NanoPacking packing, NanoStore store) {
    std::istringstream source(authored(specs, pack_none), std::ios::binary);
    const openvdb::GridPtrVecPtr grids = openvdb::io::Stream(source).getGrids();
    std::vector<nanovdb::GridHandle<>> handles;
    for (const openvdb::GridBase::Ptr& grid : *grids) handles.push_back(converted(grid, store));
    using enum nanovdb::io::Codec;
    const TempFolder scratch;
    const std::string file = scratch.file("out.nvdb");
    nanovdb::io::writeGrids<nanovdb::HostBuffer, std::vector>(file, handles,
                                                              packing == NanoPacking::zip     ? ZIP
                                                              : packing == NanoPacking::blosc ? BLOSC
                                                                                              : NONE);
    return read_file(file);
}
}
