// Read-only memory-mapped files, shared between any number of processes.
//
// A deleted file stays readable while it is mapped. If a file is truncated, or its disk goes away, the process exits
// with code 4 and a line naming the file as soon as it reads a missing page.
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
    const FileStamp& stamp() const { return stamp_; } // at the time of mapping
    std::string_view bytes() const { return {static_cast<const char*>(memory_), stamp_.size}; }

    // Throws Error (unreadable) if the file's stamp has changed since it was mapped. Renaming or deleting it is
    // allowed.
    void check_unchanged() const;

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    void* memory_ = nullptr;
    FileStamp stamp_;
    WatchedRange* range_ = nullptr;
};
}
