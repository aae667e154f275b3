// The samples that a plan gives each tile of 4×4 pixels, as a file next to it: "tyndall counts 1\n", then place and
// number of tiles (x, y, columns, rows as 32 bits), then 16 bits per tile, row by row, little-endian.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

namespace tyndall {
struct TileFactors;

// Returns the content's hash. Throws Error (unwritable).
std::string save_counts(const std::filesystem::path& file, const TileFactors& counts);

// Throws Error (unreadable, refused), also if the content does not match the hash.
std::shared_ptr<const TileFactors> load_counts(const std::filesystem::path& file, const std::string& hash);
}
