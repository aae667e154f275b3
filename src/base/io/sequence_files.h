// Every file of a numbered sequence, whatever frame shows it.
#pragma once
#include "base/io/file_sequence.h"

namespace tyndall {
// In the order of their numbers; none for a single file.
std::vector<std::filesystem::path> all_files(const FileSequence& sequence);
}
