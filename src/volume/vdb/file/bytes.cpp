#include "volume/vdb/file/bytes.h"

#include "base/error.h"
#include "base/io/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace tyndall {
namespace {
constexpr uint64_t window_bytes = 64 << 10;
}

ByteCursor::ByteCursor(const std::filesystem::path& file) : where(file.string()) {
    check_readable(file);
    descriptor_ = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (descriptor_ < 0) fail(ExitCode::unreadable, where, std::strerror(errno));
    struct stat info;
    if (fstat(descriptor_, &info) != 0 || !S_ISREG(info.st_mode)) {
        close(descriptor_);
        fail(ExitCode::unreadable, where, "is not a regular file");
    }
    end_ = static_cast<uint64_t>(info.st_size);
    buffer_.resize(std::min(window_bytes, end_));
}

ByteCursor::ByteCursor(std::string place, std::string_view bytes, uint64_t first)
    : where(std::move(place)), position_(first), end_(first + bytes.size()), window_first_(first), window_(bytes) {}

ByteCursor::~ByteCursor() {
    if (descriptor_ >= 0) close(descriptor_);
}

void ByteCursor::complain(const std::string& what) const {
    refuse(where, what + " (at byte " + std::to_string(position_) + ")");
}

void ByteCursor::require(uint64_t count, std::string_view what) const {
    if (count <= left()) return;
    refuse(where, "is truncated: " + std::string(what) + " at byte " + std::to_string(position_) + " takes " +
                      std::to_string(count) + " bytes, the file has " + std::to_string(left()) + " more");
}

void ByteCursor::read_at(uint64_t position, char* bytes, uint64_t count, std::string_view what) const {
    while (count > 0) {
        const ssize_t got = pread(descriptor_, bytes, count, static_cast<off_t>(position));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(ExitCode::unreadable, where, std::strerror(errno));
        if (got == 0) refuse(where, "was truncated while it was being read: " + std::string(what));
        bytes += got, position += static_cast<uint64_t>(got), count -= static_cast<uint64_t>(got);
    }
}

void ByteCursor::fill_window() {
    const uint64_t count = std::min<uint64_t>(buffer_.size(), left());
    read_at(position_, buffer_.data(), count, "its data");
    window_first_ = position_;
    window_ = std::string_view(buffer_.data(), count);
}

void ByteCursor::read(void* bytes, uint64_t count, std::string_view what) {
    require(count, what);
    auto* to = static_cast<char*>(bytes);
    if (descriptor_ >= 0 && count > window_bytes) { // larger than the window: read directly
        read_at(position_, to, count, what);
        position_ += count;
        return;
    }
    while (count > 0) {
        if (position_ < window_first_ || position_ >= window_first_ + window_.size()) fill_window();
        const uint64_t offset = position_ - window_first_, step = std::min(count, window_.size() - offset);
        std::memcpy(to, window_.data() + offset, step);
        to += step, count -= step, position_ += step;
    }
}

void ByteCursor::skip(uint64_t count, std::string_view what) {
    require(count, what);
    position_ += count;
}

void ByteCursor::seek(uint64_t position, std::string_view what) {
    if (position > end_)
        complain("is truncated: it ends before " + std::string(what) + " at byte " + std::to_string(position));
    position_ = position;
}

std::string ByteCursor::text(uint64_t most, std::string_view what) {
    const auto length = value<uint32_t>(what);
    if (length > most) complain(std::string(what) + " has an invalid length of " + std::to_string(length) + " bytes");
    return bytes(length, what);
}

std::string ByteCursor::bytes(uint64_t count, std::string_view what) {
    require(count, what);
    std::string result(count, '\0');
    read(result.data(), count, what);
    return result;
}
}
