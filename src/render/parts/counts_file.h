// The samples that a plan gives each tile of 4×4 pixels, as a file beside it: "tyndall counts 1\n", then place and
// number of tiles (x, y, columns, rows as 32 bits), then 16 bits for each, line by line, least significant byte first.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

namespace tyndall {
struct TileFactors;

// Returns the content's hash. Throws Error (unwritable).
std::string save_counts(const std::filesystem::path& file, const TileFactors& counts);

// Throws Error (unreadable, refused), also where the content is not that of the hash.
std::shared_ptr<const TileFactors> load_counts(const std::filesystem::path& file, const std::string& hash);
}
