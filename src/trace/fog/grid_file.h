// The file in which a medium finds its grids at a frame.
#pragma once
#include "base/io/file_sequence.h"

#include <span>

namespace tyndall {
struct MediumSource;

// The name of a medium's density grid; none if it is chosen automatically.
std::span<const std::string> density_grids(const MediumSource& medium);

// As sequence_file(), and notes gaps once. In a numbered sequence, a file without any grid is an instant without fog,
// and one without the named grids counts as missing if another one has them; what is shown instead is added to `notes`.
// Throws Error.
std::optional<std::filesystem::path> grid_file(const FileSequence& sequence, std::span<const std::string> grids,
                                               int frame, MissingFrame missing, std::vector<std::string>& notes);
}
