// Reads and writes files with every result checked. Writes are atomic: a final name never refers to a partial file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// The contents of a regular file. Throws Error: unreadable (missing, directory, device, pipe), refused (over `most`
// bytes).
std::string read_file(const std::filesystem::path& path, uint64_t most = uint64_t{64} << 20);

// The extension in lower case, with its dot: ".glb".
std::string lower_extension(const std::filesystem::path& path);

// Throws unless the path is a readable regular file; returns its size in bytes.
uint64_t check_readable(const std::filesystem::path& path);

// Writes a temporary file next to `path`, syncs it and renames it over `path`. Its directory is created if missing. On
// failure throws Error (unwritable) and removes the temporary.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);
void write_file_atomically(const std::filesystem::path& path, std::span<const std::string_view> pieces);

// Checks that a file can be created in the directory of `path`, creating the directory if missing. Throws Error
// (unwritable).
void check_output(const std::filesystem::path& path);

// Removes temporary files that killed runs of this program left in a directory (older than a day, or whose process is
// gone).
void sweep_temporaries(const std::filesystem::path& directory);

// 128-bit content hash as 32 hex digits; stable across machines.
std::string content_hash(std::string_view bytes);
std::string content_hash(std::span<const std::string_view> pieces); // of the concatenated pieces
}
