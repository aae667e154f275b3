// Files as read-only memory, which any number of processes share.
//
// A file that is deleted stays readable for those who have mapped it. Where one is cut, or its disk goes away, the
// process ends with exit code 4 and a line that names the file, as soon as it reads what is gone.
#pragma once
#include "base/io/file_hashes.h"

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace tyndall {
struct WatchedRange;

class MappedFile {
public:
    explicit MappedFile(const std::filesystem::path& path); // throws Error (unreadable)
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    const FileStamp& stamp() const { return stamp_; } // when it was mapped
    std::string_view bytes() const { return {static_cast<const char*>(memory_), stamp_.size}; }

    // Throws Error (unreadable) unless the file still has the stamp it was mapped with; its name does not count.
    void check_unchanged() const;

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    void* memory_ = nullptr;
    FileStamp stamp_;
    WatchedRange* range_ = nullptr;
};
}
