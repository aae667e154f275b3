// NanoVDB files for the tests, written by NanoVDB itself.
#pragma once
#include "volume/vdb/vdb_fixtures.h"

namespace tyndall::testing {
enum class NanoPacking { none, zip, blosc };
enum class NanoStore { plain, fp4, fp8, fp16, fpn }; // the last four of floats only

// The bytes of a file with one segment; its grids are float, double, int32, vec3s or vec3d.
std::string nano_authored(const std::vector<AuthoredGrid>& grids, NanoPacking packing = NanoPacking::none,
                          NanoStore store = NanoStore::plain);
}
