// Bytes of a file, or of a stretch of it already in memory, read forwards with every read checked.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
class ByteCursor {
public:
    // Opens a regular file; reads it through a small window. Throws Error (unreadable).
    explicit ByteCursor(const std::filesystem::path& file);
    // Bytes in memory that lie at `first` in the file that messages speak of.
    ByteCursor(std::string where, std::string_view bytes, uint64_t first);
    ~ByteCursor();
    ByteCursor(const ByteCursor&) = delete;
    ByteCursor& operator=(const ByteCursor&) = delete;

    uint64_t position() const { return position_; }
    uint64_t end() const { return end_; }
    uint64_t left() const { return end_ - position_; }

    // All throw Error (refused) naming `where`, `what` and the byte when the bytes end too early.
    void read(void* bytes, uint64_t count, std::string_view what);
    void skip(uint64_t count, std::string_view what);
    void seek(uint64_t position, std::string_view what);
    template<class T> T value(std::string_view what) {
        T result;
        read(&result, sizeof result, what);
        return result;
    }
    std::string text(uint64_t most, std::string_view what);    // a 32-bit length, then that many bytes
    std::string bytes(uint64_t count, std::string_view what);  // memory is asked for only when the bytes are there
    [[noreturn]] void complain(const std::string& what) const; // refuses, adding the byte

    std::string where; // the file, and the grid being read

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
