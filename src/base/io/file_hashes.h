// Content hashes of whole files, each worked out once: a file counts as it was when it was first asked for.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace tyndall {
// Size and time of the last change: a file that keeps both is taken for unchanged.
struct FileStamp {
    uint64_t size = 0;
    int64_t changed = 0; // nanoseconds since 1970
    bool operator==(const FileStamp&) const = default;
};

// Throws Error (unreadable).
FileStamp stamp_of(const std::filesystem::path& path);

struct StampedHash {
    FileStamp stamp;
    std::string hash;
};

struct FileHashes {
    std::map<std::filesystem::path, StampedHash> known{}; // stamps are those before reading
    // Worked out by an earlier run, by absolute path: stand for files that keep their stamps. `recorded_in` names the
    // file that says so.
    std::map<std::filesystem::path, StampedHash> recorded{};
    std::filesystem::path recorded_in{};
};

// Absolute, without dots; what FileHashes::recorded goes by.
std::filesystem::path normal_path(const std::filesystem::path& path);

// Throws Error: unreadable; refused, where the file no longer has the content on record.
const std::string& file_hash(const std::filesystem::path& path, FileHashes& files);
}
