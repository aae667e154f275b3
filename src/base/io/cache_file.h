// One thing that was costly to make, as a file: a header, then the bytes of its fields, arrays where vectors can load
// them. The layout is that of this build's structs; names of files hold the build (cache_folder.h).
//
// A struct says its fields once, for reading and writing: template<class Visit> void fields(Thing&, Visit&&), which
// calls visit(member) for each.
#pragma once
#include "base/io/mapped_file.h"
#include "base/shared_array.h"

#include <cstring>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tyndall {
// An open file whose header is right.
struct CacheFile {
    MappedFile file;
    std::string_view body;
    std::string hash;   // of the body
    double seconds = 0; // that making the thing took
};

// `made_from`: 32 hex digits that tell what the thing depends on; `seconds`: what making it took. Returns the hash of
// the body. Throws Error (unwritable); a final name only ever holds a complete file.
std::string write_cache_file(const std::filesystem::path& path, std::string_view made_from, double seconds,
                             std::span<const std::string_view> body);

// Bytes of a file with a body of so many.
uint64_t cache_file_size(std::span<const std::string_view> body);

// Throws Error: unreadable; refused, where the header is damaged or of something else.
std::shared_ptr<const CacheFile> open_cache_file(const std::filesystem::path& path, std::string_view made_from);

// Reads every byte. Throws Error (refused) where one is not as it was written.
void check_body(const CacheFile& file);

inline constexpr size_t cache_alignment = 64; // of arrays

template<class T>
concept PlainBytes = std::is_trivially_copyable_v<T>;

// Puts fields down as pieces of a body. Arrays are not copied: they have to live on.
class CacheWriter {
public:
    template<PlainBytes T> void operator()(const T& value) {
        add_copy({reinterpret_cast<const char*>(&value), sizeof value});
    }
    void operator()(const std::string& text) { (*this)(text.size()), add_copy(text); }
    template<PlainBytes T> void operator()(const std::vector<T>& values) { add_array<T>(values); }
    template<PlainBytes T> void operator()(const SharedArray<T>& values) {
        add_array<T>({values.data(), values.size()});
    }
    template<PlainBytes T> void operator()(const std::shared_ptr<const std::vector<T>>& values) {
        add_array<T>(values ? std::span<const T>(*values) : std::span<const T>());
    }

    std::span<const std::string_view> pieces() const { return pieces_; }

private:
    void add(std::string_view bytes) { pieces_.push_back(bytes), size_ += bytes.size(); }
    void add_copy(std::string_view bytes) { add(copies_.emplace_back(bytes)); }
    template<class T> void add_array(std::span<const T> values) {
        (*this)(values.size());
        add_copy(std::string((cache_alignment - size_ % cache_alignment) % cache_alignment, '\0'));
        add({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
    }

    std::deque<std::string> copies_;
    std::vector<std::string_view> pieces_;
    size_t size_ = 0;
};

// Takes fields from a body in the same order. Shared arrays stay in the file. Throws Error (refused).
class CacheReader {
public:
    explicit CacheReader(std::shared_ptr<const CacheFile> file) : file_(std::move(file)) {}

    template<PlainBytes T> void operator()(T& value) { std::memcpy(&value, take(1, sizeof value), sizeof value); }
    void operator()(std::string& text) {
        const size_t size = take_size();
        text.assign(take(size, 1), size);
    }
    template<PlainBytes T> void operator()(std::vector<T>& values) {
        const std::span<const T> array = take_array<T>();
        values.assign(array.begin(), array.end());
    }
    template<PlainBytes T> void operator()(SharedArray<T>& values) { values = {take_array<T>(), file_}; }
    template<PlainBytes T> void operator()(std::shared_ptr<const std::vector<T>>& values) { // empty = null
        const std::span<const T> array = take_array<T>();
        if (!array.empty()) values = std::make_shared<const std::vector<T>>(array.begin(), array.end());
    }
    void finish() const; // all has to be read

private:
    const char* take(size_t count, size_t size);
    size_t take_size();
    template<class T> std::span<const T> take_array() {
        const size_t count = take_size();
        take((cache_alignment - at_ % cache_alignment) % cache_alignment, 1);
        return {reinterpret_cast<const T*>(take(count, sizeof(T))), count};
    }

    std::shared_ptr<const CacheFile> file_;
    size_t at_ = 0;
};
}
