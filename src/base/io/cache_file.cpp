#include "base/io/cache_file.h"

#include "base/error.h"
#include "base/io/file.h"

#include <array>

namespace tyndall {
namespace {
constexpr std::string_view magic = "tyndall cache 1\n";

struct CacheHeader {
    std::array<char, 16> magic{};
    uint64_t body_bytes = 0;
    double seconds = 0;
    std::array<char, 32> made_from{}, body_hash{}, header_hash{}; // header_hash covers all fields before it
};
static_assert(sizeof(CacheHeader) == 2 * cache_alignment);

std::string_view text(const std::array<char, 32>& digits) { return {digits.data(), digits.size()}; }

std::string hash_of_header(const CacheHeader& header) {
    return content_hash({reinterpret_cast<const char*>(&header), offsetof(CacheHeader, header_hash)});
}

template<size_t n> void put(std::string_view from, std::array<char, n>& to) {
    std::copy_n(from.data(), std::min(from.size(), n), to.begin());
}

[[noreturn]] void refuse_damaged(const std::filesystem::path& path, const char* what) {
    refuse(path.string(), std::string("is damaged: ") + what + "; remove it and prepare again");
}
}

uint64_t cache_file_size(std::span<const std::string_view> body) {
    uint64_t size = sizeof(CacheHeader);
    for (const std::string_view piece : body) size += piece.size();
    return size;
}

std::string write_cache_file(const std::filesystem::path& path, std::string_view made_from, double seconds,
                             std::span<const std::string_view> body) {
    CacheHeader header;
    header.seconds = seconds;
    header.body_bytes = cache_file_size(body) - sizeof header;
    const std::string hash = content_hash(body);
    put(magic, header.magic), put(made_from, header.made_from), put(hash, header.body_hash);
    put(hash_of_header(header), header.header_hash);
    std::vector<std::string_view> pieces{{reinterpret_cast<const char*>(&header), sizeof header}};
    pieces.insert(pieces.end(), body.begin(), body.end());
    write_file_atomically(path, pieces);
    return hash;
}

std::shared_ptr<const CacheFile> open_cache_file(const std::filesystem::path& path, std::string_view made_from) {
    auto file = std::shared_ptr<CacheFile>(new CacheFile{MappedFile(path), {}, {}, 0});
    const std::string_view bytes = file->file.bytes();
    CacheHeader header;
    if (bytes.size() < sizeof header) refuse_damaged(path, "it is shorter than its header");
    std::memcpy(&header, bytes.data(), sizeof header);
    if (std::string_view(header.magic.data(), header.magic.size()) != magic ||
        text(header.header_hash) != hash_of_header(header))
        refuse_damaged(path, "its header is corrupt");
    if (text(header.made_from) != made_from) refuse_damaged(path, "its content does not match its name");
    file->body = bytes.substr(sizeof header);
    if (header.body_bytes != file->body.size()) refuse_damaged(path, "its size does not match its header");
    file->hash = text(header.body_hash), file->seconds = header.seconds;
    return file;
}

void check_body(const CacheFile& file) {
    if (content_hash(file.body) != file.hash) refuse_damaged(file.file.path(), "its checksum does not match");
}

const char* CacheReader::take(size_t count, size_t size) {
    if (count > (file_->body.size() - at_) / size) refuse_damaged(file_->file.path(), "its data ends early");
    const char* bytes = file_->body.data() + at_;
    at_ += count * size;
    return bytes;
}

size_t CacheReader::take_size() {
    size_t size = 0;
    (*this)(size);
    return size;
}

void CacheReader::finish() const {
    if (at_ != file_->body.size()) refuse_damaged(file_->file.path(), "it has extra data at its end");
}
}
