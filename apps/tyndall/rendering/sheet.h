// The contact sheet of a render with several modes: images with times, and errors against a reference.
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

// Throws Error (unreadable, refused) when a frame's reference is missing or has another size.
void check_sheet_reference(const std::string& pattern, std::span<const int> frames, ivec2 size);

// `pattern` names the reference, which is shown last; empty = none. Throws Error.
void write_sheet(const std::filesystem::path& sheet, const std::vector<SheetEntry>& entries, const std::string& pattern,
                 int frame, const Display& display);
}
