#include "base/io/file.h"

#include "base/error.h"
#include "base/io/temporary.h"
#include "base/text.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace tyndall {
namespace fs = std::filesystem;

namespace {
[[noreturn]] void fail_reading(const fs::path& path, int error) {
    fail(ExitCode::unreadable, path.string(), error == ENOENT ? "no such file" : std::strerror(error));
}

struct Input {
    int descriptor = -1;
    uint64_t size = 0;

    // Nonblocking, so that opening a pipe without a writer returns; only regular files are accepted.
    explicit Input(const fs::path& path)
        : descriptor(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {
        if (descriptor < 0) fail_reading(path, errno);
        struct stat info;
        const int error = fstat(descriptor, &info) == 0 ? 0 : errno;
        if (!error && S_ISREG(info.st_mode)) {
            size = static_cast<uint64_t>(info.st_size);
            return;
        }
        close(descriptor);
        if (error) fail_reading(path, error);
        fail(ExitCode::unreadable, path.string(),
             S_ISDIR(info.st_mode) ? "is a directory, not a file" : "is not a regular file");
    }
    ~Input() { close(descriptor); }
    Input(const Input&) = delete;
    Input& operator=(const Input&) = delete;
};

// The path to replace: for a symbolic link its target, so that the link itself stays.
fs::path final_path(const fs::path& path) {
    std::error_code error;
    if (!fs::is_symlink(path, error)) return path;
    const fs::path target = fs::canonical(path, error);
    return error ? path : target;
}

// Refuses a final name that a rename would destroy (directory, device, pipe) or that the file system does not allow.
void check_final_name(const fs::path& path) {
    if (!path.has_filename() || path.filename() == "." || path.filename() == "..")
        fail(ExitCode::unwritable, path.string(), "is not a file name");
    if (path.native().find('\0') != std::string::npos)
        fail(ExitCode::unwritable, path.string(), "contains a zero byte");
    struct stat info;
    if (stat(path.c_str(), &info) != 0) {
        if (errno != ENOENT) fail(ExitCode::unwritable, path.string(), std::strerror(errno));
        return;
    }
    if (S_ISDIR(info.st_mode)) fail(ExitCode::unwritable, path.string(), "is a directory");
    if (!S_ISREG(info.st_mode)) fail(ExitCode::unwritable, path.string(), "is a device or pipe, not a regular file");
}
}

std::string lower_extension(const fs::path& path) { return lower_case(path.extension().string()); }

std::string read_file(const fs::path& path, uint64_t most) {
    const Input input(path);
    const auto check_size = [&](uint64_t size) {
        if (size > most) refuse(path.string(), "is larger than " + std::to_string(most) + " bytes");
    };
    check_size(input.size);

    // Read to end of file rather than to the reported size: the file may grow, and /proc files report a size of 0.
    std::string bytes(input.size + 1, '\0');
    size_t filled = 0;
    for (;;) {
        if (filled == bytes.size()) bytes.resize(2 * bytes.size());
        const ssize_t got = read(input.descriptor, bytes.data() + filled, bytes.size() - filled);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail_reading(path, errno);
        if (got == 0) break;
        filled += static_cast<size_t>(got);
        check_size(filled);
    }
    bytes.resize(filled);
    return bytes;
}

uint64_t check_readable(const fs::path& path) { return Input(path).size; }

void write_file_atomically(const fs::path& path, std::span<const std::string_view> pieces) {
    const fs::path target = final_path(path);
    check_final_name(target);
    Temporary temporary(target);
    for (const std::string_view piece : pieces) temporary.write(piece.data(), piece.size());
    temporary.sync_and_close();
    temporary.rename_over_final();
}

void write_file_atomically(const fs::path& path, std::string_view text) {
    write_file_atomically(path, std::span(&text, 1));
}

void write_file_atomically(const fs::path& path, std::span<const std::byte> bytes) {
    write_file_atomically(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void check_output(const fs::path& path) {
    const fs::path target = final_path(path);
    std::error_code error;
    if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
    if (error) fail(ExitCode::unwritable, path.string(), "cannot create its directory: " + error.message());
    check_final_name(target);
    Temporary temporary(target);
}
}
