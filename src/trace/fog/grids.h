// What a medium reads from grids besides its density, at one moment: albedo and emission.
#pragma once
#include "trace/fog/grid_property.h"

namespace tyndall {
struct FogFrames;
struct MediumGrids;
struct MediumSource;
struct SequenceTime;

// Emission of a medium, which becomes a separate medium (see append_light()).
struct EmissionPart {
    std::shared_ptr<const EmissionField> field;
    PlacedBricks luminance;
    vec3 radiance{0};
};

// The light of one of two files that are blended, which adds up: between a flame and the air beside it, a blended
// temperature would hardly glow.
struct BlendedLight {
    int frame = 0;
    float share = 0;
    float unit = 1; // as FogSource::unit, of that frame
    std::shared_ptr<const MediumGrids> grids;
};

// All grid properties of a medium, and what is derived from them before and after the medium's transform.
struct MediumGrids {
    GridProperty albedo, emission, temperature, flame;
    std::string key; // of the derived members below
    std::shared_ptr<const AlbedoField> color;
    vec3 mean_factor{1}; // of `color`
    EmissionPart blackbody, colored;
    mat4 matrix{1};
    bool is_placed = false;
    std::shared_ptr<const AlbedoField> placed_color;
    EmissionPart placed_blackbody, placed_colored;
    std::vector<BlendedLight> blended;       // in place of own emission, temperature and flame
    std::shared_ptr<const FogFrames> frames; // for fog that moves while the shutter is open; else null
};

// The grids of a medium at a moment, with its files at `time`; `fog` holds its density, if any. Shares with `before`
// (may be null) what comes from the same files. Stores the files read for a time between frames in `frames`. Throws
// Error.
std::shared_ptr<const MediumGrids> medium_grids(const MediumSource& source, Moment moment, const SequenceTime& time,
                                                MissingFrame missing, const mat4& matrix, const FogSource& fog,
                                                const MediumGrids* before, FogFrames& frames, Snapshot& snapshot);

// Sets a medium's albedo field, and appends its emission to the snapshot's media; `unit`: that of its density.
void color_medium(const MediumSource& source, double seconds, const MediumGrids& grids, Medium& medium);
void append_light(const MediumSource& source, const Moment& moment, const MediumGrids& grids, float unit,
                  Snapshot& snapshot);

// Whether a medium has grids besides its density.
bool has_grids(const MediumSource& source);
}
