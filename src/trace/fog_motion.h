// Fog of files while the shutter is open: which frames of a sequence a moment lies between, or beside.
#pragma once
#include "trace/snapshot.h"
#include "volume/motion/velocity_field.h"

namespace tyndall {
struct GridProperty;
struct GridSource;
struct MediumSource;
struct PlacedBricks;
struct SparseVolume;

struct FileVelocity {
    std::string key, content; // as of bricks
    VelocityField field;
};

// What of its files a medium shows at a moment: those of `frame`, and of that after them `share`; or moved.
struct SequenceTime {
    int frame = 0;
    float share = 0;
    double moved = 0; // seconds or frames, times the medium's scale
    std::shared_ptr<const FileVelocity> velocity;

    bool between() const { return share > 0 || velocity; }
    std::string key() const, content() const; // as of bricks
};

// What the next moment needs as well of fog that moves: what its files hold.
struct FogFrames {
    std::vector<FogSource> densities;
    std::array<std::vector<GridProperty>, 4> properties; // albedo, emission, temperature, flame
    std::shared_ptr<const FileVelocity> velocity;
    double moved = 0; // as of the time
};

// Whether a medium moves while the shutter is open.
bool moves(const MediumSource& source);

// `before` lends its velocity. Beyond the first and the last file those go on. Throws Error.
SequenceTime sequence_time(const Scene& scene, const MediumSource& source, const Moment& moment, MissingFrame missing,
                           const FogFrames* before, Snapshot& snapshot);

// Bricks of one quantity at that time: of the frame, and of the next one where they are mixed.
SparseVolume volume_at(const SequenceTime& time, const PlacedBricks& here, const PlacedBricks& next,
                       const std::string& what);

// A file as keys name it: its path, size and time.
std::string file_key(const std::filesystem::path& file);

// The most voxels that the medium's velocities move it by in a second; 0 where nothing does.
double voxels_per_second(const Scene& scene, const MediumSource& source, const FogSource& fog);

// How far a medium of a snapshot with moments is moved by its velocities from where a file has it, in voxels, and how
// many moments have it in a place of its own.
struct FogTravel {
    double voxels = 0;
    int places = 0;
};
FogTravel fog_travel(const Snapshot& snapshot, size_t medium);
}
