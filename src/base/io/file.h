// Files read and written with every result checked. A final name only ever holds a complete file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// The whole of a regular file. Throws Error: unreadable (missing, directory, device, pipe), refused (over `most`
// bytes).
std::string read_file(const std::filesystem::path& path, uint64_t most = uint64_t{64} << 20);

// Of a name, in lower case: ".glb".
std::string lower_extension(const std::filesystem::path& path);

// Throws unless the path is a readable regular file; returns its size in bytes.
uint64_t check_readable(const std::filesystem::path& path);

// Writes a temporary beside `path`, syncs it and renames it over `path`. Throws Error (unwritable) and leaves nothing.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);
void write_file_atomically(const std::filesystem::path& path, std::span<const std::string_view> pieces);

// Makes sure a file can be made in the directory of `path`, creating the directory when missing. Throws Error
// (unwritable).
void check_output(const std::filesystem::path& path);

// Removes temporaries of earlier, killed runs of this program in a directory (older than a day, or whose process is
// gone).
void sweep_temporaries(const std::filesystem::path& directory);

// 128-bit content hash as 32 hex digits; stable across machines.
std::string content_hash(std::string_view bytes);
std::string content_hash(std::span<const std::string_view> pieces); // of the pieces joined
}
