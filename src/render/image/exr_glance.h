// What an EXR of ours says of itself, from its header and the place of its last block: nothing is decoded, so that tens
// of thousands of files take a second.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace tyndall {
struct ExrGlance {
    std::string frame, part, plan_hash; // imageCounter, tyndall:part and tyndall:planHash; empty where there is none
    bool partial = false;               // tyndall:partial: merged while parts were missing
};

// None where there is no file. Throws Error (unreadable, refused): no EXR of scanlines, or one that does not end where
// its last block does, as when it was cut off.
std::optional<ExrGlance> glance_at_exr(const std::filesystem::path& file);
}
