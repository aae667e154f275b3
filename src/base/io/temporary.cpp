#include "base/io/temporary.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <sstream>

namespace tyndall {
namespace {
constexpr size_t longest_name = 255, random_digits = 16;

std::string random_tag() {
    uint64_t bits = 0;
    if (getrandom(&bits, sizeof bits, GRND_NONBLOCK) != sizeof bits)
        bits = static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
    return hex_digits(bits);
}

std::string host_tag() {
    char name[65] = {};
    if (gethostname(name, sizeof name - 1) != 0 || !name[0]) return "localhost";
    for (char* c = name; *c; ++c)
        if (*c == '/') *c = '_';
    return name;
}

// Process ids are only unique within one namespace: containers may share a host name and a directory.
std::string namespace_tag() {
    struct stat info;
    return stat("/proc/self/ns/pid", &info) == 0 ? std::to_string(info.st_ino) : "0";
}

std::filesystem::path temporary_name(const std::filesystem::path& path) {
    std::ostringstream tail, stem;
    tail << '.' << host_tag() << '.' << namespace_tag() << '-' << getpid() << '.' << random_tag() << ".tmp";
    stem << '.' << path.filename().string().substr(0, longest_name - 1 - tail.str().size());
    return path.parent_path() / (stem.str() + tail.str());
}

// Splits the part after the last dot off `text`; false if there is no dot.
bool take_field(std::string_view& text, std::string_view& field) {
    const size_t dot = text.rfind('.');
    if (dot == std::string_view::npos) return false;
    field = text.substr(dot + 1);
    text = text.substr(0, dot);
    return true;
}

bool parse_whole(std::string_view text, uint64_t& value, int base = 10) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

struct Owner {
    std::string_view space;
    uint64_t process = 0;
};

// Parses which process wrote a temporary; false for any name this program would not create on this host.
bool parse_owner(std::string_view name, const std::string& host, Owner& owner) {
    std::string_view suffix, random, process;
    if (!take_field(name, suffix) || !take_field(name, random) || !take_field(name, process)) return false;
    const size_t dash = process.find('-');
    uint64_t bits, space;
    if (suffix != "tmp" || random.size() != random_digits || !parse_whole(random, bits, 16)) return false;
    if (dash == std::string_view::npos || !parse_whole(process.substr(0, dash), space)) return false;
    if (!parse_whole(process.substr(dash + 1), owner.process) || owner.process < 1 || owner.process > INT32_MAX)
        return false;
    owner.space = process.substr(0, dash);
    return name.starts_with('.') && name.ends_with("." + host) && name.size() > host.size() + 2;
}
}

Temporary::Temporary(const std::filesystem::path& path) : final_(path) {
    for (int attempt = 0; attempt < 16 && descriptor_ < 0; ++attempt) {
        // The folder may be gone: a process that fails removes those it made, where others may be about to write.
        std::error_code ignored;
        if (attempt > 0) std::filesystem::create_directories(path.parent_path(), ignored);
        name_ = temporary_name(path);
        descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (descriptor_ < 0 && errno != EEXIST && errno != EINTR && errno != ENOENT) break;
    }
    if (descriptor_ < 0) fail_with("cannot create a file in its directory");
    exists_ = true;
    struct stat info;
    if (fstat(descriptor_, &info) == 0) device_ = info.st_dev, inode_ = info.st_ino;
}

Temporary::~Temporary() {
    if (descriptor_ >= 0) close(descriptor_);
    if (exists_) unlink(name_.c_str());
}

void Temporary::fail_with(const char* step) const {
    fail(ExitCode::unwritable, final_.string(), std::string(step) + ": " + std::strerror(errno));
}

void Temporary::write(const char* bytes, size_t count) {
    constexpr size_t max_at_once = size_t{1} << 30;
    while (count > 0) {
        const ssize_t written = ::write(descriptor_, bytes, std::min(count, max_at_once));
        if (written < 0 && errno == EINTR) continue;
        if (written == 0) errno = ENOSPC;
        if (written <= 0) fail_with("cannot write");
        bytes += written, count -= static_cast<size_t>(written);
    }
}

void Temporary::sync_and_close() {
    int synced;
    do synced = fsync(descriptor_);
    while (synced != 0 && errno == EINTR);
    if (synced != 0 && errno != EINVAL) fail_with("cannot sync to disk");

    // close() releases the descriptor even on error, so never retry it; if interrupted, the data are already synced.
    const int closed = close(descriptor_);
    descriptor_ = -1;
    if (closed != 0 && errno != EINTR) fail_with("cannot close");
}

void Temporary::rename_over_final() {
    if (rename(name_.c_str(), final_.c_str()) != 0) {
        // Network file systems may report failure for a rename that succeeded.
        const int error = errno;
        struct stat info;
        const bool arrived = stat(final_.c_str(), &info) == 0 && info.st_dev == device_ && info.st_ino == inode_;
        errno = error;
        if (!arrived) fail_with("cannot rename to the final name");
    }
    exists_ = false;

    // The new name is durable only once its directory is synced. Directories that cannot be opened are skipped.
    const auto parent = final_.parent_path();
    const int directory = open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0) return;
    const bool synced = fsync(directory) == 0 || errno == EINVAL || errno == EINTR;
    const int error = errno;
    close(directory);
    errno = error;
    if (!synced) fail_with("cannot sync its directory");
}

void sweep_temporaries(const std::filesystem::path& directory) {
    constexpr time_t day = 24 * 60 * 60;
    const std::string host = host_tag(), space = namespace_tag();
    const time_t now = time(nullptr);
    std::error_code ignored;
    std::filesystem::directory_iterator entry(directory.empty() ? "." : directory, ignored);
    for (; !ignored && entry != std::filesystem::directory_iterator(); entry.increment(ignored)) {
        const std::string name = entry->path().filename().string();
        Owner owner;
        struct stat info;
        if (!parse_owner(name, host, owner) || lstat(entry->path().c_str(), &info) != 0 || !S_ISREG(info.st_mode))
            continue;
        const bool gone = owner.space == space && kill(static_cast<pid_t>(owner.process), 0) != 0 && errno == ESRCH;
        if (gone || now - info.st_mtime > day) unlink(entry->path().c_str());
    }
}
}
