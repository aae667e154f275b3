// How fast fog moves where: what a velocity grid of a file says, ready for sampling.
#pragma once
#include "volume/vdb/vdb.h"

#include <array>
#include <memory>

namespace tyndall {
struct BrickPool;

// Velocities in the file's lengths per unit of time, trilinear between voxels that are known.
struct VelocityField {
    std::array<std::shared_ptr<const BrickPool>, 3> components; // (velocity - low) / range, 0 where not known
    std::array<std::shared_ptr<const BrickPool>, 3> known;      // 1 where it is; on the voxels of the component
    std::array<dmat4, 3> index_to_world{dmat4(1), dmat4(1), dmat4(1)};
    vec3 low{0}, range{0};
    float fastest = 0; // no speed is above it; 0 = nothing moves
};

// Throws Error as make_bricks().
VelocityField make_velocity_field(VelocityVolume volume);

// A field as it is seen from fog: in index coordinates of that, voxels of it per unit of time.
class LocalVelocity {
public:
    LocalVelocity(const VelocityField& field, const dmat4& index_to_world);

    // False where no velocity is known.
    bool at(vec3 point, vec3& velocity) const;

private:
    std::array<std::shared_ptr<const BrickPool>, 3> components_, known_;
    vec3 low_, range_;
    mat3 to_index_;
};
}
