// Temporary files next to the final ones, named so that a later run can recognize its own leftovers.
#pragma once
#include <filesystem>
#include <string>

namespace tyndall {
// A file opened for writing under a unique name `.<name>.<host>.<pid namespace>-<pid>.<random>.tmp` in the directory of
// `path`, which is created if it is missing. Deleted on destruction unless it was renamed. Every step throws Error
// (unwritable) naming `path`.
class Temporary {
public:
    explicit Temporary(const std::filesystem::path& path);
    ~Temporary();
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;

    void write(const char* bytes, size_t count);
    void sync_and_close();
    void rename_over_final();

private:
    [[noreturn]] void fail_with(const char* step) const;
    std::filesystem::path final_, name_;
    int descriptor_ = -1;
    bool exists_ = false;
    unsigned long device_ = 0, inode_ = 0;
};
}
