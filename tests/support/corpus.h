// Files by others: those in tests/data, and a larger collection in the same layout where there is one.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall::test {
// The files below a folder of either collection, each name once and sorted by it; a failure when there is none.
std::vector<std::filesystem::path> corpus_files(std::string_view folder,
                                                const std::vector<std::string>& extensions = {});

// Those of the named files that there are; a failure when there is none.
std::vector<std::filesystem::path> corpus_files_named(const std::vector<std::string>& names);

// One file, which must be there.
std::filesystem::path corpus_file(const std::string& name);
}
