// Checked forward reading of a file, or of a part of it already in memory.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
class ByteCursor {
public:
    // Opens a regular file and reads it through a small buffer. Throws Error (unreadable).
    explicit ByteCursor(const std::filesystem::path& file);
    // Reads bytes in memory that start at offset `first` of the file named in messages.
    ByteCursor(std::string where, std::string_view bytes, uint64_t first);
    ~ByteCursor();
    ByteCursor(const ByteCursor&) = delete;
    ByteCursor& operator=(const ByteCursor&) = delete;

    uint64_t position() const { return position_; }
    uint64_t end() const { return end_; }
    uint64_t left() const { return end_ - position_; }

    // All throw Error (refused) naming `where`, `what` and the byte position if the data end too early.
    void read(void* bytes, uint64_t count, std::string_view what);
    void skip(uint64_t count, std::string_view what);
    void seek(uint64_t position, std::string_view what);
    template<class T> T value(std::string_view what) {
        T result;
        read(&result, sizeof result, what);
        return result;
    }
    std::string text(uint64_t most, std::string_view what);    // a 32-bit length, then that many bytes
    std::string bytes(uint64_t count, std::string_view what);  // allocates only if that many bytes exist
    [[noreturn]] void complain(const std::string& what) const; // refuses, adding the byte position

    std::string where; // file and current grid, for messages

private:
    void require(uint64_t count, std::string_view what) const;
    void fill_window();
    void read_at(uint64_t position, char* bytes, uint64_t count, std::string_view what) const;

    int descriptor_ = -1;
    uint64_t position_ = 0, end_ = 0;
    uint64_t window_first_ = 0;
    std::string_view window_;
    std::vector<char> buffer_;
};
}
