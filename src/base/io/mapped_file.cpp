#include "base/io/mapped_file.h"

#include "base/error.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <string>

namespace tyndall {
// A mapped range of memory and the error line to print if reading it fails. Ranges are reused but never freed, because
// the signal handler walks the list.
struct WatchedRange {
    std::atomic<const char*> begin = nullptr; // null = free
    std::atomic<size_t> size = 0;
    std::string line;
    WatchedRange* next = nullptr;
};

namespace {
std::atomic<WatchedRange*> ranges = nullptr;
struct sigaction previous_action;

// Handles SIGBUS from a mapped page that is gone. Any other fault goes to the previous handler.
void on_bus_error(int, siginfo_t* info, void*) {
    const bool is_fault = info->si_code > 0; // otherwise sent by kill()
    const char* at = static_cast<const char*>(info->si_addr);
    for (const WatchedRange* range = ranges; is_fault && range; range = range->next) {
        const char* begin = range->begin;
        if (!begin || at < begin || at >= begin + range->size) continue;
        if (write(STDERR_FILENO, range->line.data(), range->line.size()) < 0)
            _exit(static_cast<int>(ExitCode::internal));
        _exit(static_cast<int>(ExitCode::unreadable));
    }
    sigaction(SIGBUS, &previous_action, nullptr);
    raise(SIGBUS); // delivered when this returns
}

void handle_bus_errors() {
    static std::once_flag once;
    std::call_once(once, [] {
        struct sigaction action {};
        action.sa_sigaction = on_bus_error, action.sa_flags = SA_SIGINFO;
        sigaction(SIGBUS, &action, &previous_action);
    });
}

WatchedRange* watched(const void* memory, size_t size, const std::string& file) {
    static std::mutex adding;
    const std::scoped_lock lock(adding);
    WatchedRange* range = ranges;
    while (range && range->begin) range = range->next;
    const bool fresh = !range;
    if (fresh) range = new WatchedRange;
    range->line = "tyndall: error: " + printable(file, 400) +
                  ": was truncated, or its disk became unavailable, while it was in use\n";
    range->size = size, range->begin = static_cast<const char*>(memory);
    if (fresh) range->next = ranges, ranges = range;
    return range;
}

FileStamp stamp_of_open(int descriptor, const std::filesystem::path& path) {
    struct stat info;
    if (fstat(descriptor, &info) != 0) fail(ExitCode::unreadable, path.string(), std::strerror(errno));
    if (!S_ISREG(info.st_mode)) fail(ExitCode::unreadable, path.string(), "is not a regular file");
    return stamp_of(info);
}
}

MappedFile::MappedFile(const std::filesystem::path& path)
    : path_(path), descriptor_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {
    if (descriptor_ < 0)
        fail(ExitCode::unreadable, path.string(), errno == ENOENT ? "no such file" : std::strerror(errno));
    try {
        stamp_ = stamp_of_open(descriptor_, path);
        if (stamp_.size == 0) return;
        memory_ = mmap(nullptr, stamp_.size, PROT_READ, MAP_SHARED, descriptor_, 0);
        if (memory_ == MAP_FAILED) memory_ = nullptr, fail(ExitCode::unreadable, path.string(), std::strerror(errno));
    } catch (const Error&) {
        close(descriptor_);
        throw;
    }
    handle_bus_errors();
    range_ = watched(memory_, stamp_.size, path.string());
}

MappedFile::~MappedFile() {
    if (range_) range_->begin = nullptr;
    if (memory_) munmap(memory_, stamp_.size);
    close(descriptor_);
}

void MappedFile::check_unchanged() const {
    if (stamp_of_open(descriptor_, path_) != stamp_)
        fail(ExitCode::unreadable, path_.string(), "was changed while it was in use");
}
}
