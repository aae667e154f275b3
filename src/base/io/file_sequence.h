// Numbered sequences of volume or image files, and which file belongs to a frame.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tyndall {
enum class SequenceMode { hold, loop, ping_pong, clip }; // before the first and after the last file
enum class MissingFrame { error, hold, skip };           // at a gap: stop · use the nearest earlier file · use none
inline const std::vector<std::string> missing_frame_names{"error", "hold", "skip"};

struct FileSequence {
    std::string pattern; // a file, or a name with a frame token (####, %04d, $F4, @@@@, <F4>)
    SequenceMode mode = SequenceMode::hold;
    int offset = 0;         // file frame = scene frame + offset
    std::vector<int> files; // frames found on disk, ascending; empty for a single file
};

// Lists the files that match the pattern. Throws Error (unreadable) if there are none.
FileSequence find_sequence(const std::string& pattern, const std::filesystem::path& base_directory);

// Every file of a numbered sequence, in the order of their numbers; none for a single file.
std::vector<std::filesystem::path> all_files(const FileSequence& sequence);

// The file for a scene frame; nothing if the frame has none (clip, skip). Throws Error (unreadable) at a gap with
// MissingFrame::error.
std::optional<std::filesystem::path> sequence_file(const FileSequence& sequence, int frame, MissingFrame missing);

// Names the missing files at a frame and what is shown instead of them; empty if none is missing. The same for all
// frames of a gap.
std::string gap_note(const FileSequence& sequence, int frame, MissingFrame missing);
}
