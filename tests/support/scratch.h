// A directory of its own for a test, removed at the end.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
class TempFolder {
public:
    TempFolder();
    ~TempFolder();
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
    std::string file(std::string_view name) const { return (path_ / name).string(); }

    // Writes a file, in folders made for it; returns its path.
    std::filesystem::path put(std::string_view name, std::string_view bytes) const;

    // Names of files and folders in it, sorted.
    std::vector<std::string> names() const;

    // Its files by name, with their bytes; where headers of images name the folder, or have a hash of that, are dashes.
    std::map<std::string, std::string> contents() const;

private:
    std::filesystem::path path_;
};

std::string bytes_of(const std::filesystem::path& path);

// The bytes of an image with dashes instead of these names and of the hash over its header.
std::string without_names(std::string bytes, const std::vector<std::string>& names);
}
