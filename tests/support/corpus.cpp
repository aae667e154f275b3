#include "support/corpus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;

const fs::path collections[] = {fs::path(TYNDALL_SOURCE_DIR) / "tests/data", TYNDALL_SHARED_DATA};
}

std::vector<fs::path> corpus_files(std::string_view folder, const std::vector<std::string>& extensions) {
    std::map<fs::path, fs::path> found;
    for (const fs::path& collection : collections) {
        if (!fs::is_directory(collection / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(collection / folder)) {
            const bool wanted =
                extensions.empty() || std::ranges::count(extensions, entry.path().extension().string()) > 0;
            if (entry.is_regular_file() && wanted) found.emplace(entry.path().lexically_relative(collection), entry);
        }
    }
    EXPECT_FALSE(found.empty()) << "no files in " << folder;
    std::vector<fs::path> files;
    for (const auto& [name, file] : found) files.push_back(file);
    return files;
}

std::vector<fs::path> corpus_files_named(const std::vector<std::string>& names) {
    std::vector<fs::path> files;
    for (const std::string& name : names)
        for (const fs::path& collection : collections)
            if (fs::exists(collection / name)) {
                files.push_back(collection / name);
                break;
            }
    EXPECT_FALSE(files.empty()) << "none of " << testing::PrintToString(names);
    return files;
}

fs::path corpus_file(const std::string& name) {
    const std::vector<fs::path> files = corpus_files_named({name});
    return files.empty() ? fs::path(name) : files[0];
}
}
