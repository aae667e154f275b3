// File sequences while the shutter is open: the frames that a moment lies between, or that its fog is moved from.
#pragma once
#include "trace/snapshot.h"
#include "volume/motion/velocity_field.h"

#include <optional>
#include <span>

namespace tyndall {
struct GridProperty;
struct GridSource;
struct MediumSource;
struct PlacedBricks;
struct SparseVolume;

struct FileVelocity {
    std::string key, content; // as FogSource::key and BrickPool::content
    VelocityField field;
};

// How a medium's files give its state at a moment: `frame` blended with the next by `share`, or moved by `velocity`.
struct SequenceTime {
    int frame = 0;
    float share = 0;
    double moved = 0; // seconds or frames to move by, times the medium's velocity scale; 0 where nothing moves
    std::shared_ptr<const FileVelocity> velocity;

    bool between() const { return share > 0 || moved != 0; }
    std::string key() const, content() const; // as FogSource::key and BrickPool::content
};

// File contents of moving fog, kept for the next moment.
struct FogFrames {
    std::vector<FogSource> densities; // of SequenceTime::frame and, where files are blended, of the next one
    std::array<std::vector<GridProperty>, 4> properties; // albedo, emission, temperature, flame
    std::shared_ptr<const FileVelocity> velocity;
    int frame = 0;    // as in SequenceTime
    double moved = 0; // as in SequenceTime
};

// Whether a medium moves while the shutter is open.
bool moves(const MediumSource& source);

// A medium's position in its file sequence at a moment. Holds the first and last file beyond the sequence's ends.
// Reuses the velocity of `before` (may be null). Throws Error.
SequenceTime sequence_time(const Scene& scene, const MediumSource& source, const Moment& moment, MissingFrame missing,
                           const FogFrames* before, Snapshot& snapshot);

// How errors name a quantity that moves: scene file, medium, quantity.
std::string moved_name(const Scene& scene, const std::string& medium, std::string_view quantity);

// One quantity at that time, from its bricks at the frame and, where files are blended, at the next one.
SparseVolume volume_at(const SequenceTime& time, const PlacedBricks& here, const PlacedBricks& next,
                       const std::string& what);

// Notes once which files of a sequence are missing at a frame.
void note_gap(const FileSequence& sequence, int frame, MissingFrame missing, std::vector<std::string>& notes);

// The file of a frame as by grid_file(), and what identifies what is read from it, `text` about grids of `kind`, as in
// FogSource::key and BrickPool::content. Throws Error.
struct SequencedFile {
    std::filesystem::path path;
    std::string key, content;
};
std::optional<SequencedFile> file_at(const FileSequence& sequence, std::span<const std::string> grids, int frame,
                                     MissingFrame missing, std::string_view kind, const std::string& text,
                                     Snapshot& snapshot);

// Largest speed of the medium's velocities, voxels per second; 0 without velocities.
double voxels_per_second(const Scene& scene, const MediumSource& source, const FogSource& fog);

// Over a snapshot's moments: how far velocities move a medium from its position in a file at most, in voxels, and how
// many distinct positions it has.
struct FogTravel {
    double voxels = 0;
    int places = 0;
};
FogTravel fog_travel(const Snapshot& snapshot, size_t medium);
}
