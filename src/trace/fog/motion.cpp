#include "trace/fog/motion.h"

#include "base/error.h"
#include "base/io/cache_folder.h"
#include "base/io/file.h"
#include "base/text.h"
#include "scene/scene.h"
#include "trace/fog/grid_file.h"
#include "trace/fog/grids.h"
#include "volume/bricks/bricks.h"
#include "volume/motion/moved_fog.h"

#include <algorithm>
#include <set>

namespace tyndall {
namespace {
// Offset of the moment's time from its frame, in frames; 0 within rounding.
double frames_after(const Scene& scene, const Moment& moment) {
    constexpr double rounding = 1e-9;
    const double frames = moment.grown.value_or(moment.seconds) * scene.frame_rate - moment.frame;
    return std::abs(frames) < rounding ? 0 : frames;
}

std::shared_ptr<const FileVelocity> velocity_of(const GridSource& source, int frame, MissingFrame missing,
                                                const std::shared_ptr<const FileVelocity>& before, Snapshot& snapshot) {
    const auto file = file_at(source.sequence, source.grids, frame, missing, "velocity", source.text(), snapshot);
    if (!file) return nullptr;
    if (before && before->key == file->key) return before;
    VdbReadReport report;
    auto velocity = std::make_shared<FileVelocity>();
    velocity->key = file->key, velocity->content = file->content;
    velocity->field = make_velocity_field(read_velocity_vdb(file->path, source.grids, source.map, &report));
    if (const std::string note = report.summary(); !note.empty())
        snapshot.notes.push_back(file->path.filename().string() + ": " + note);
    return velocity;
}

// The frame whose file is moved: the nearest, or `frame` if the nearest has no file of its own.
int nearest_frame(const MediumSource& source, int frame, double after, MissingFrame missing) {
    const auto steps = static_cast<int>(after > 0 ? std::ceil(after - 0.5) : std::floor(after + 0.5));
    if (steps == 0) return frame;
    const auto there = sequence_file(source.sequence, frame + steps, missing);
    return there && there != sequence_file(source.sequence, frame, missing) ? frame + steps : frame;
}

// Path, size and modification time.
std::string file_key(const std::filesystem::path& file) {
    const uint64_t size = check_readable(file);
    const auto changed = std::filesystem::last_write_time(file).time_since_epoch().count();
    return "file " + file.string() + " " + std::to_string(size) + " " + std::to_string(changed) + " ";
}
}

void note_gap(const FileSequence& sequence, int frame, MissingFrame missing, std::vector<std::string>& notes) {
    std::string note = gap_note(sequence, frame, missing);
    if (!note.empty() && !std::ranges::count(notes, note)) notes.push_back(std::move(note));
}

std::optional<SequencedFile> file_at(const FileSequence& sequence, std::span<const std::string> grids, int frame,
                                     MissingFrame missing, std::string_view kind, const std::string& text,
                                     Snapshot& snapshot) {
    auto path = grid_file(sequence, grids, frame, missing, snapshot.notes);
    if (!path) return std::nullopt;
    SequencedFile file{std::move(*path), {}, {}};
    file.key = file_key(file.path) + text;
    if (const CacheFolder* files = snapshot.files.get())
        file.content = std::string(kind) + " " + file_hash(file.path, *files->inputs) + " " + text;
    return file;
}

bool moves(const MediumSource& source) { return source.velocity || (source.blends && !source.sequence.files.empty()); }

namespace {
std::string time_text(const SequenceTime& time) { return formatted(" %a %a ", double{time.share}, time.moved); }
}

std::string SequenceTime::key() const { return time_text(*this) + (velocity ? velocity->key : ""); }
std::string SequenceTime::content() const { return time_text(*this) + (velocity ? velocity->content : ""); }

SequenceTime sequence_time(const Scene& scene, const MediumSource& source, const Moment& moment, MissingFrame missing,
                           const FogFrames* before, Snapshot& snapshot) {
    SequenceTime time;
    time.frame = moment.frame;
    // The first moment tells how often to move the fog, even if it is the frame's own.
    const double after = moves(source) ? frames_after(scene, moment) : 0;
    if (after == 0 && !(source.velocity && moment.grown)) return time;
    if (source.blends) {
        const double whole = std::floor(after);
        time.frame += static_cast<int>(whole), time.share = static_cast<float>(after - whole);
        return time;
    }
    time.frame = nearest_frame(source, moment.frame, after, missing);
    const double frames = after - (time.frame - moment.frame), scale = double{source.velocity->scale};
    time.velocity =
        velocity_of(source.velocity->grid, time.frame, missing, before ? before->velocity : nullptr, snapshot);
    if (time.velocity && time.velocity->field.fastest > 0)
        time.moved = scale * (source.velocity->per_frame ? frames : frames / scene.frame_rate);
    return time;
}

std::string moved_name(const Scene& scene, const std::string& medium, std::string_view quantity) {
    return scene.file.string() + ": " + named("medium", medium) + ": " + std::string(quantity);
}

SparseVolume volume_at(const SequenceTime& time, const PlacedBricks& here, const PlacedBricks& next,
                       const std::string& what) {
    if (time.moved == 0) return blended_fog(here, next, time.share, what);
    return here.bricks ? moved_fog(here, time.velocity->field, time.moved, what) : SparseVolume();
}

namespace {
// Smallest side of the voxels of all that moves; infinity if nothing does.
double smallest_voxel(const FogSource& fog) {
    double smallest = infinity;
    const auto add = [&](const std::shared_ptr<const BrickPool>& bricks, const dmat4& index_to_world) {
        if (!bricks || !(bricks->highest > 0)) return;
        for (int axis = 0; axis < 3; ++axis) smallest = std::min(smallest, glm::length(dvec3(index_to_world[axis])));
    };
    add(fog.bricks, fog.index_to_world);
    if (const MediumGrids* grids = fog.grids.get())
        for (const GridProperty* property : {&grids->albedo, &grids->emission, &grids->temperature, &grids->flame})
            for (const PlacedBricks& channel : property->channels) add(channel.bricks, channel.index_to_world);
    return smallest;
}

// The largest distance, in voxels, that velocities move fog in their unit of time.
double voxels_per_time(const FogSource& fog) {
    const FogFrames* frames = fog.grids ? fog.grids->frames.get() : nullptr;
    return frames && frames->velocity ? double{frames->velocity->field.fastest} / smallest_voxel(fog) : 0;
}
}

double voxels_per_second(const Scene& scene, const MediumSource& source, const FogSource& fog) {
    if (!source.velocity) return 0;
    const double speed = voxels_per_time(fog) * std::abs(double{source.velocity->scale});
    return source.velocity->per_frame ? speed * scene.frame_rate : speed;
}

FogTravel fog_travel(const Snapshot& snapshot, size_t medium) {
    FogTravel travel;
    std::set<std::pair<int, double>> places;
    for (const Snapshot& moment : *snapshot.moments) {
        const FogSource& fog = moment.fog_sources[medium];
        const double speed = voxels_per_time(fog);
        if (speed == 0) continue;
        const FogFrames& frames = *fog.grids->frames;
        travel.voxels = std::max(travel.voxels, speed * std::abs(frames.moved));
        places.insert({frames.frame, frames.moved});
    }
    travel.places = static_cast<int>(places.size());
    return travel;
}
}
