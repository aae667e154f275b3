// The sheet of a render with several modes: their pictures with times, and errors against a reference.
#pragma once
#include "render/image/view_transform.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tyndall {
struct SheetEntry {
    std::string mode, times;
    std::filesystem::path file; // the EXR of one frame
};

// Throws Error (unreadable, refused) where a frame's reference is not there or has another size.
void check_sheet_reference(const std::string& pattern, std::span<const int> frames, ivec2 size);

// With a reference, `pattern` at that frame, it is shown last; empty = none. Throws Error.
void write_sheet(const std::filesystem::path& sheet, const std::vector<SheetEntry>& entries, const std::string& pattern,
                 int frame, const Display& display);
}
