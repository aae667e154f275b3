#include "base/io/file_hashes.h"

#include "base/error.h"
#include "base/io/file.h"

#include <fstream>

#include <sys/stat.h>

#include <cerrno>
#include <cstring>

namespace tyndall {
namespace {
// Hash of the hashes of a file's 1 MiB pieces, so that files of any size need little memory.
std::string hash_of_file(const std::filesystem::path& path) {
    check_readable(path);
    std::ifstream stream(path, std::ios::binary);
    std::string piece(size_t{1} << 20, '\0'), hashes;
    while (stream) {
        stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        hashes += content_hash(std::string_view(piece).substr(0, static_cast<size_t>(stream.gcount())));
    }
    if (stream.bad() || !stream.eof()) fail(ExitCode::unreadable, path.string(), "cannot be read to the end");
    return content_hash(hashes);
}
}

FileStamp stamp_of(const struct stat& info) {
    return {static_cast<uint64_t>(info.st_size), int64_t{info.st_mtim.tv_sec} * 1'000'000'000 + info.st_mtim.tv_nsec};
}

FileStamp stamp_of(const std::filesystem::path& path) {
    struct stat info;
    if (stat(path.c_str(), &info) != 0)
        fail(ExitCode::unreadable, path.string(), errno == ENOENT ? "no such file" : std::strerror(errno));
    return stamp_of(info);
}

std::filesystem::path normal_path(const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal();
}

const std::string& file_hash(const std::filesystem::path& path, FileHashes& files) {
    const auto known = files.known.find(path);
    if (known != files.known.end()) return known->second.hash;
    StampedHash now{stamp_of(path), {}};
    const auto record = files.recorded.find(normal_path(path));
    const bool recorded = record != files.recorded.end();
    now.hash = recorded && record->second.stamp == now.stamp ? record->second.hash : hash_of_file(path);
    if (recorded && now.hash != record->second.hash)
        refuse(path.string(), "has changed since " + files.recorded_in.string() + " was written: prepare again");
    return files.known.emplace(path, std::move(now)).first->second.hash;
}
}
