#include "viewer/editing/missing_frames.h"
#include "scene/input_files.h"
#include "scene/scene.h"

#include <filesystem>
#include <optional>

namespace tyndall {
namespace {
// The file that is held for a gap of a sequence at the frame; empty if there is no gap.
std::optional<std::filesystem::path> held_file(const MediumSource& medium, int frame) {
    for (const FileSequence* sequence : volume_sequences(medium))
        if (!sequence_file(*sequence, frame, MissingFrame::skip))
            if (const auto held = sequence_file(*sequence, frame, MissingFrame::hold)) return held;
    return {};
}
}

std::vector<int> missing_frames(const Scene& scene) {
    std::vector<int> frames;
    for (int frame = scene.first_frame; frame <= scene.last_frame; ++frame)
        for (const MediumSource& medium : scene.media)
            if (held_file(medium, frame)) {
                frames.push_back(frame);
                break;
            }
    return frames;
}

std::string missing_text(const Scene& scene, int frame, MissingFrame missing) {
    for (const MediumSource& medium : scene.media) {
        const auto held = held_file(medium, frame);
        if (!held) continue;
        const std::string text = "a file of " + medium.name + " is missing at this frame";
        if (missing == MissingFrame::hold) return text + ": " + held->filename().string() + " is held";
        return text + (missing == MissingFrame::skip ? ": no fog" : "");
    }
    return {};
}
}
