#include "viewer/editing/missing_frames.h"
#include "scene/scene.h"

#include <filesystem>
#include <optional>

namespace tyndall {
namespace {
// The file that is held when a gap of the sequence is at the frame; nothing where there is no gap.
std::optional<std::filesystem::path> held_file(const MediumSource& medium, int frame) {
    if (medium.kind != MediumKind::vdb || sequence_file(medium.sequence, frame, MissingFrame::skip)) return {};
    return sequence_file(medium.sequence, frame, MissingFrame::hold);
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
