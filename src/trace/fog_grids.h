// What a medium takes from grids beside its density, at one moment: colors, and light of its own.
#pragma once
#include "trace/snapshot.h"
#include "volume/emission/luminance.h"

#include <optional>

namespace tyndall {
struct FogFrames;
struct MediumSource;
struct SequenceTime;

// One property, as its file has it.
struct GridProperty {
    std::string key;                      // empty = nothing to reuse
    std::array<PlacedBricks, 3> channels; // the first thrice for a grey grid
    PlacedBricks there;                   // of colors
    explicit operator bool() const { return channels[0].bricks != nullptr; }
};

// Light that a medium gives off, of which a medium of its own is made.
struct EmissionPart {
    std::shared_ptr<const EmissionField> field;
    PlacedBricks luminance;
    vec3 radiance{0};
};

// All properties of a medium, what follows from them, and that where its transform puts it.
struct MediumGrids {
    GridProperty albedo, emission, temperature, flame;
    std::string key; // of what follows
    std::shared_ptr<const AlbedoField> color;
    vec3 mean_factor{1}; // of `color`
    EmissionPart blackbody, colored;
    mat4 matrix{1};
    bool is_placed = false;
    std::shared_ptr<const AlbedoField> placed_color;
    EmissionPart placed_blackbody, placed_colored;
    std::shared_ptr<const FogFrames> frames; // of fog that moves while the shutter is open; null = of none
};

// Of a medium with grids at a moment, when its files are at `time`; `fog` has its density, if there is any. What
// `before` (may be null) has of the same files is shared with it. Files that it lies between are left in `frames`.
// Throws Error.
std::shared_ptr<const MediumGrids> medium_grids(const MediumSource& source, Moment moment, const SequenceTime& time,
                                                MissingFrame missing, const mat4& matrix, const FogSource& fog,
                                                const MediumGrids* before, FogFrames& frames, Snapshot& snapshot);

// Gives a medium its colors, and appends its light to the snapshot's media.
void color_medium(const MediumSource& source, double seconds, const MediumGrids& grids, Medium& medium);
void append_light(const MediumSource& source, double seconds, const MediumGrids& grids, Snapshot& snapshot);

// Whether a medium has grids beside its density.
bool has_grids(const MediumSource& source);
}
