#include "support/scratch.h"

#include <gtest/gtest.h>

#include <stdlib.h>

#include <fstream>

namespace tyndall {
TempFolder::TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "tyndall_test_XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    path_ = name;
}

TempFolder::~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TempFolder::put(std::string_view name, std::string_view bytes) const {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

std::vector<std::string> TempFolder::names() const {
    std::vector<std::string> result;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) result.push_back(entry.path().filename());
    std::ranges::sort(result);
    return result;
}

std::map<std::string, std::string> TempFolder::contents() const {
    std::map<std::string, std::string> result;
    for (const std::string& name : names())
        if (std::filesystem::is_regular_file(path_ / name)) result[name] = bytes_of(path_ / name);
    for (auto& [name, bytes] : result) bytes = without_names(bytes, {path_.filename().string()});
    return result;
}

std::string without_names(std::string bytes, const std::vector<std::string>& names) {
    for (const std::string& name : names)
        for (size_t at = bytes.find(name); at != bytes.npos; at = bytes.find(name, at))
            bytes.replace(at, name.size(), name.size(), '-');
    const std::string check("tyndall:check\0string\0", 21); // then 4 bytes of length, and 32 of hash
    if (const size_t at = bytes.find(check); at != bytes.npos && at + check.size() + 36 <= bytes.size())
        bytes.replace(at + check.size() + 4, 32, 32, '-');
    return bytes;
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}
}
