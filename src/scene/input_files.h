// The files that a scene is made of: which of them a frame reads, and that no command may overwrite any.
#pragma once
#include "base/io/output.h"
#include "scene/scene.h"

namespace tyndall {
// The first and the last frame whose files a medium uses while a frame's shutter is open.
std::pair<int, int> frames_shown(const MediumSource& medium, int frame, const Shutter& shutter);

// The files of sequences that a frame reads, volumes first; `path` is empty where a sequence has none. Throws Error for
// a gap.
struct FrameFile {
    bool volume = true; // else a gobo
    std::optional<std::filesystem::path> path;
};
std::vector<FrameFile> frame_files(const Scene& scene, int frame, MissingFrame missing, const Shutter& shutter);

// A gobo's image for a frame; MissingFrame::skip holds the previous image, as hold does.
std::filesystem::path gobo_file(const GoboSource& gobo, int frame, MissingFrame missing);

// The file sequences of a medium, of its density and of every other property, without duplicates.
std::vector<const FileSequence*> volume_sequences(const MediumSource& medium);

// Throws Error (usage) if an output is one of the scene's files: of the scene itself, or of any number of a sequence.
void spare_files(const Scene& scene, const OutputPaths& places);
}
