// Content hashes of whole files, each computed once: later changes to a file are not seen.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

struct stat;

namespace tyndall {
// Size and modification time: a file that keeps both is assumed unchanged.
struct FileStamp {
    uint64_t size = 0;
    int64_t changed = 0; // nanoseconds since 1970
    bool operator==(const FileStamp&) const = default;
};

// The second throws Error (unreadable).
FileStamp stamp_of(const struct stat& info);
FileStamp stamp_of(const std::filesystem::path& path);

struct StampedHash {
    FileStamp stamp;
    std::string hash;
};

struct FileHashes {
    std::map<std::filesystem::path, StampedHash> known{}; // by path as given; stamps are taken before reading
    // From an earlier run, by absolute path; valid for files whose stamps still match. `recorded_in` names the file
    // that lists them.
    std::map<std::filesystem::path, StampedHash> recorded{};
    std::filesystem::path recorded_in{};
};

// The absolute path without dot components: the key of FileHashes::recorded.
std::filesystem::path normal_path(const std::filesystem::path& path);

// Throws Error: unreadable; refused if the file's content differs from the recorded hash.
const std::string& file_hash(const std::filesystem::path& path, FileHashes& files);
}
