// A file's velocity grid, prepared for sampling.
#pragma once
#include "volume/vdb/vdb.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall {
struct BrickPool;

// Bricks of 9³ voxels that hold {known, x, y, z}, of the fields of the same names below: one lookup for all four.
struct JointBricks {
    std::vector<int32_t> index; // of the cells of known[0]: brick n-1, or 0 where nothing is known
    std::vector<vec4> values;   // [brick·729 + (x·9 + y)·9 + z]
};

// Velocities in the file's units of length and time, trilinear between known voxels.
struct VelocityField {
    std::array<std::shared_ptr<const BrickPool>, 3> components; // (velocity - low) / range, 0 where unknown; ...
    std::array<std::shared_ptr<const BrickPool>, 3> known; // 1 at its known voxels; both null: 0 wherever others are
    std::shared_ptr<const BrickPool> any;                  // 1 where at least one is known, the others 0; null: ...
    dmat4 any_to_world{1};                                 // ... only where all are
    std::shared_ptr<const JointBricks> joint;              // null if components have voxels of their own, or too many
    std::array<dmat4, 3> index_to_world{dmat4(1), dmat4(1), dmat4(1)};
    vec3 low{0}, range{0};
    float fastest = 0; // upper bound of the speed; 0 = nothing moves
};

// Throws Error like make_bricks().
VelocityField make_velocity_field(VelocityVolume volume);

// A field in the index coordinates of a fog grid, in its voxels per unit of time.
class LocalVelocity {
public:
    LocalVelocity(const VelocityField& field, const dmat4& index_to_world);

    // Returns false where no velocity is known.
    bool at(vec3 point, vec3& velocity) const;

private:
    vec4 joint_at(vec3 point) const;

    std::array<std::shared_ptr<const BrickPool>, 3> components_, known_;
    std::shared_ptr<const BrickPool> any_;
    std::shared_ptr<const JointBricks> joint_;
    vec3 low_, range_;
    mat3 to_index_;
};
}
