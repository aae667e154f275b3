// Numbered files, of volumes or images, and which of them belongs to a frame.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tyndall {
enum class SequenceMode { hold, loop, ping_pong, clip }; // before the first and after the last file
enum class MissingFrame { error, hold, skip };           // a gap inside: stop · use the nearest earlier · nothing
inline const std::vector<std::string> missing_frame_names{"error", "hold", "skip"};

struct FileSequence {
    std::string pattern; // a file, or a name with a frame token (####, %04d, $F4, @@@@, <F4>)
    SequenceMode mode = SequenceMode::hold;
    int offset = 0;         // file frame = scene frame + offset
    std::vector<int> files; // frames found on disk, ascending; empty for a single file
};

// Lists the files of the pattern. Throws Error (unreadable) when there is none.
FileSequence find_sequence(const std::string& pattern, const std::filesystem::path& base_directory);

// The file for a scene frame; nothing where it has none (clip, skip). Throws Error (unreadable) for a gap.
std::optional<std::filesystem::path> sequence_file(const FileSequence& sequence, int frame, MissingFrame missing);
}
