#include "base/io/sequence_files.h"

namespace tyndall {
std::vector<std::filesystem::path> all_files(const FileSequence& sequence) {
    FileSequence numbered = sequence;
    numbered.mode = SequenceMode::hold, numbered.offset = 0;
    std::vector<std::filesystem::path> files;
    for (const int number : sequence.files) files.push_back(*sequence_file(numbered, number, MissingFrame::hold));
    return files;
}
}
