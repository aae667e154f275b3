// EXR parts: the sums of one part of a frame's samples, as floats.
//
// Each node has the channels sSECTION_LEVEL_INDEX.NAME, NAME being surface.R/G/B, background.R/G/B, inscatter.R/G/B,
// weight, alpha, transmittance, validity, kept, taken, and lightN.R/G/B for each part of inscatter; Z and offset are
// those of the sample nearest the pixel's center. All are 32 bit floats.
#pragma once
#include "render/frame/part.h"
#include "render/image/exr.h"

#include <filesystem>
#include <string>

namespace tyndall {
struct Grouping;

// The range of the requested part. Throws Error (usage) if there are more parts than a frame can have.
PartRange range_of(const Grouping& grouping, const Mode& mode, const View& view);

struct PartFile {
    std::filesystem::path file, plan_file;
    FramePart part;        // without its sums
    std::string hash;      // of everything its frame depends on
    std::string plan_hash; // of the plan
    std::string label;     // such as 3/8
    int frame = 0;
};

// out.0001.exr and part 3 of 8 make out.0001.part-3-of-8.exr.
std::string part_name(const std::string& frame_file, const Grouping& grouping);

// Writes a part with the provenance's hash and frame. An unfinished part is a checkpoint: not compressed, and with the
// channel `finished`. Throws Error (unwritable, internal).
void write_part(const std::filesystem::path& file, const FramePart& part, Provenance provenance,
                const Grouping& grouping);

// Reads a part without its sums and checks that every byte is as written. Throws Error (unreadable, refused).
PartFile read_part(const std::filesystem::path& file);

// Fewest and most samples per pixel in a section.
struct SectionSamples {
    int fewest = 0, most = 1 << 24;
};

// Reads `count` rows of the part, from row `first` on, with their sums. Throws Error (unreadable, refused).
FramePart read_rows(const PartFile& part, int first, int count, const SectionSamples& section);

// The checkpoint of a part: frame.part-1-of-3.checkpoint for frame.part-1-of-3.exr.
std::filesystem::path checkpoint_name(const std::filesystem::path& part);

// Reads the unfinished requested part; none if there is no such file or, with the reason in `why`, if it cannot be
// used.
std::optional<FramePart> read_checkpoint(const std::filesystem::path& file, const std::string& hash,
                                         const Grouping& grouping, std::string& why);

// Whether the file is that part, finished; otherwise `why` is the reason (empty: there is no file).
bool is_finished_part(const std::filesystem::path& file, const std::string& hash, const Grouping& grouping,
                      std::string& why);
}
