#include "render/image/exr_glance.h"

#include "base/error.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tyndall {
namespace {
constexpr size_t first_read = 8192, longest_header = 1 << 20;

// An open file, read piece by piece.
class ReadFile {
public:
    explicit ReadFile(const std::filesystem::path& file) : name_(file.string()) {
        descriptor_ = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
        if (descriptor_ < 0 && errno != ENOENT) fail(ExitCode::unreadable, name_, std::strerror(errno));
        struct stat status {};
        if (descriptor_ < 0) return;
        if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
            close(descriptor_); // the destructor does not run
            fail(ExitCode::unreadable, name_, "is not a regular file");
        }
        bytes_ = static_cast<uint64_t>(status.st_size);
    }
    ~ReadFile() {
        if (descriptor_ >= 0) close(descriptor_);
    }
    ReadFile(const ReadFile&) = delete;
    ReadFile& operator=(const ReadFile&) = delete;

    bool is_there() const { return descriptor_ >= 0; }
    uint64_t bytes() const { return bytes_; }

    // Reads up to the buffer's size; less at the end of the file.
    std::string_view read(uint64_t offset, std::span<char> buffer) const {
        const ssize_t got =
            offset < bytes_ ? pread(descriptor_, buffer.data(), buffer.size(), static_cast<off_t>(offset)) : 0;
        if (got < 0) fail(ExitCode::unreadable, name_, std::strerror(errno));
        return {buffer.data(), static_cast<size_t>(got)};
    }

private:
    std::string name_;
    int descriptor_ = -1;
    uint64_t bytes_ = 0;
};

// Reads the bytes of a header in order; `short_of` is set when they end early.
struct Taken {
    std::string_view left;
    bool short_of = false;

    std::string_view bytes(size_t count) {
        short_of = short_of || count > left.size();
        if (short_of) return {};
        const std::string_view result = left.substr(0, count);
        left.remove_prefix(count);
        return result;
    }
    int32_t integer() {
        int32_t value = 0;
        if (const std::string_view text = bytes(4); !short_of) std::memcpy(&value, text.data(), 4);
        return value;
    }
    std::string_view name() {
        const size_t end = left.find('\0');
        const std::string_view result = bytes(end == left.npos ? left.size() + 1 : end);
        bytes(1);
        return result;
    }
};

// Where the table of blocks begins, and how many blocks there are.
struct BlockTable {
    size_t start = 0;
    int64_t blocks = 0, first_line = 0, lines = 1; // lines: per block
};

// None if the header is longer than the bytes.
std::optional<BlockTable> read_header(std::string_view bytes, const std::string& file, ExrSummary& summary) {
    Taken taken{bytes};
    if (taken.integer() != 20000630 || (taken.integer() & ~0x400) != 2)
        if (!taken.short_of) refuse(file, "is not a scanline OpenEXR image");
    BlockTable table;
    int32_t low = 0, high = -1;
    while (true) {
        const std::string_view name = taken.name();
        if (taken.short_of) return {};
        if (name.empty()) break;
        const std::string_view type = taken.name();
        const int32_t size = taken.integer();
        if (size < 0) refuse(file, "damaged: an attribute has a negative size");
        Taken value{taken.bytes(static_cast<size_t>(size))};
        if (taken.short_of) return {};
        if (name == "imageCounter" && type == "int") summary.frame = std::to_string(value.integer());
        if (name == "tyndall:part") summary.part = value.left;
        if (name == "tyndall:planHash") summary.plan_hash = value.left;
        if (name == "tyndall:partial") summary.partial = true;
        if (name == "dataWindow") value.integer(), low = value.integer(), value.integer(), high = value.integer();
        if (name == "compression" && size == 1) table.lines = value.left[0] == 3 ? 16 : 1;
    }
    if (high < low) refuse(file, "damaged: the header has no data window");
    table.start = bytes.size() - taken.left.size(), table.first_line = low;
    table.blocks = (int64_t{high} - low) / table.lines + 1;
    return table;
}

// Whether the last block's table entry, line and size agree with the end of the file.
bool ends_with_last_block(const ReadFile& file, std::string_view bytes, const BlockTable& table) {
    std::array<char, 8> room{};
    const uint64_t place = table.start + 8 * static_cast<uint64_t>(table.blocks - 1);
    const std::string_view entry = place + 8 <= bytes.size() ? bytes.substr(place, 8) : file.read(place, room);
    if (entry.size() < 8) return false;
    uint64_t offset = 0;
    std::memcpy(&offset, entry.data(), 8);
    Taken block{file.read(offset, room)};
    const int32_t line = block.integer(), size = block.integer();
    return !block.short_of && line == table.first_line + table.lines * (table.blocks - 1) && size > 0 &&
           offset + 8 + static_cast<uint64_t>(size) == file.bytes();
}
}

std::optional<ExrSummary> exr_summary(const std::filesystem::path& path) {
    const ReadFile file(path);
    if (!file.is_there()) return {};
    std::vector<char> buffer;
    for (size_t length = first_read;; length = longest_header) {
        buffer.resize(length);
        ExrSummary summary;
        const std::string_view bytes = file.read(0, buffer);
        if (const auto table = read_header(bytes, path.string(), summary)) {
            if (ends_with_last_block(file, bytes, *table)) return summary;
            refuse(path.string(), "truncated: it ends before the end of its last block");
        }
        if (bytes.size() == file.bytes()) refuse(path.string(), "truncated: it ends within its header");
        if (length == longest_header) refuse(path.string(), "damaged: its header is longer than 1 MiB");
    }
}
}
