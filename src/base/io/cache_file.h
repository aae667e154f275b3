// One expensive precomputed object as a file: a header, then the bytes of its fields, with arrays aligned for SIMD
// loads. The layout is that of this build's structs, so file names include the build (cache_folder.h).
//
// A struct lists its fields once, for both reading and writing, in template<class Visit> void fields(Thing&, Visit&&),
// which calls visit(member) for each.
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
// An open file whose header is valid.
struct CacheFile {
    MappedFile file;
    std::string_view body;
    std::string hash;   // of the body
    double seconds = 0; // that building the object took
};

// `made_from`: 32 hex digits that identify the object's inputs; `seconds`: the time it took to build. Returns the hash
// of the body. Throws Error (unwritable). The write is atomic: `path` never names a partial file.
std::string write_cache_file(const std::filesystem::path& path, std::string_view made_from, double seconds,
                             std::span<const std::string_view> body);

// Size in bytes of a file with this body.
uint64_t cache_file_size(std::span<const std::string_view> body);

// Throws Error: unreadable; refused if the header is damaged or belongs to another object.
std::shared_ptr<const CacheFile> open_cache_file(const std::filesystem::path& path, std::string_view made_from);

// Reads every byte of the body and compares its hash. Throws Error (refused) on a mismatch.
void check_body(const CacheFile& file);

inline constexpr size_t cache_alignment = 64; // of arrays

template<class T>
concept PlainBytes = std::is_trivially_copyable_v<T>;

// Collects fields as pieces of a body. Arrays are not copied and must outlive the writer.
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

// Reads fields from a body in the order written. Shared arrays point into the mapped file. Throws Error (refused).
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
    void finish() const; // refuses unread bytes

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
