// What an EXR of ours says of itself, from its header and the place of its last block: nothing is decoded, so that tens
// of thousands of files take a second.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace tyndall {
struct ExrGlance {
    std::map<std::string, std::string> texts; // attributes that are strings or whole numbers
    uint64_t bytes = 0;
};

// None where there is no file. Throws Error (unreadable, refused): no EXR of scanlines, or one that does not end where
// its last block does, as when it was cut off.
std::optional<ExrGlance> glance_at_exr(const std::filesystem::path& file);
}
