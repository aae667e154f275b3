// A quick check of EXR files by header and position of the last block: nothing is decoded, so that tens of thousands of
// files take a second.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace tyndall {
struct ExrSummary {
    std::string frame, part, plan_hash; // imageCounter, tyndall:part and tyndall:planHash; empty where there is none
    bool partial = false;               // tyndall:partial: merged while parts were missing
};

// None if there is no file. Throws Error (unreadable, refused) if it is not a scanline EXR or is truncated: it has to
// end with its last block.
std::optional<ExrSummary> exr_summary(const std::filesystem::path& file);
}
