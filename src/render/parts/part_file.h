// EXR parts: the sums of one part of a frame's samples, float by float.
//
// For each node the channels sSECTION_LEVEL_INDEX.NAME, NAME being surface.R/G/B, background.R/G/B, inscatter.R/G/B,
// weight, alpha, transmittance, validity, kept, taken, and lightN.R/G/B for each part of fog light; Z and offset of the
// sample nearest the pixel's centre. All are 32 bit floats.
#pragma once
#include "render/frame/part.h"
#include "render/image/exr.h"

#include <filesystem>
#include <string>

namespace tyndall {
struct Grouping;

// What the part that is asked for holds. Throws Error (usage) where there are more parts than a frame has.
PartRange range_of(const Grouping& grouping, const Mode& mode, const View& view);

struct PartFile {
    std::filesystem::path file, plan_file;
    FramePart part;        // without its sums
    std::string hash;      // of all its frame depends on
    std::string plan_hash; // of the plan
    std::string label;     // 3/8
    int frame = 0;
};

// out.0001.exr and part 3 of 8 make out.0001.part-3-of-8.exr.
std::string part_name(const std::string& frame_file, const Grouping& grouping);

// Throws Error (unwritable, internal). The provenance's hash and frame go with it. One that is unfinished is a
// checkpoint: not packed, and with the channel `finished`.
void write_part(const std::filesystem::path& file, const FramePart& part, Provenance provenance,
                const Grouping& grouping);

// Throws Error (unreadable, refused): every byte has to be as it was written.
PartFile read_part(const std::filesystem::path& file);

// The fewest and the most samples of a pixel that a section may hold.
struct SectionSamples {
    int fewest = 0, most = 1 << 24;
};

// So many rows of the part, with their sums. Throws Error (unreadable, refused).
FramePart read_rows(const PartFile& part, int first, int count, const SectionSamples& section);

// frame.part-1-of-3.exr: what is rendered of it so far is kept in frame.part-1-of-3.checkpoint.
std::filesystem::path checkpoint_name(const std::filesystem::path& part);

// The part that is asked for as far as it is there; none where there is no such file, or `why` there is no using it.
std::optional<FramePart> read_checkpoint(const std::filesystem::path& file, const std::string& hash,
                                         const Grouping& grouping, std::string& why);

// Whether the file is that part already; `why` says why not (empty: there is no file).
bool is_finished_part(const std::filesystem::path& file, const std::string& hash, const Grouping& grouping,
                      std::string& why);
}
