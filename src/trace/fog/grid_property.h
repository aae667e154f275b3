// One property that a medium reads from grids: albedo, emission, temperature or flame, at a moment.
#pragma once
#include "trace/snapshot.h"
#include "volume/emission/luminance.h"

#include <optional>

namespace tyndall {
struct FogFrames;
struct GridSource;
struct MediumGrids;
struct MediumSource;
struct SequenceTime;

// One property as read from its file, before the medium's transform.
struct GridProperty {
    std::string key;                      // empty = nothing to reuse
    std::array<PlacedBricks, 3> channels; // the same pool three times for a gray grid
    PlacedBricks coverage;                // colors only: 1 at voxels that have one
    explicit operator bool() const { return channels[0].bricks != nullptr; }
};

// What a property holds: scalars, colors, or colors limited to 1.
enum class Quantity { number, color, share };

// Shared arguments for reading properties.
struct ReadContext {
    const std::string& medium; // its name
    Moment moment;
    const SequenceTime& time;
    MissingFrame missing;
    const MediumGrids* before;
    FogFrames& frames;
    Snapshot& snapshot;
};

// The property at the moment; `number`: its index in FogFrames::properties. Reuses `before` (may be null) and what is
// known of the moment before where they come from the same files. Throws Error.
GridProperty grid_property(const std::optional<GridSource>& source, size_t number, Quantity quantity,
                           const ReadContext& reading, const GridProperty* before);

// The temperature of a recipe's fire.
GridProperty grown_temperature(const MediumSource& source, const ReadContext& reading, const GridProperty* before);
}
