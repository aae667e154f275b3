// Where a command's files go: names checked, directories tested before any work, nothing left of a run that failed.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// Throws Error (usage) unless the pattern ends in `extension` and has no foreign frame token; `several` frames need
// one.
void check_pattern(const std::string& pattern, std::string_view extension, bool several,
                   std::string_view option = "--output");

// Makes sure every file can be written. Directories it makes are removed again when they end empty.
class OutputPlaces {
public:
    ~OutputPlaces();
    // Throws Error (unwritable).
    void check(const std::filesystem::path& file);
    void check(const std::string& pattern, const std::vector<int>& frames, std::string_view option = "--output");

private:
    std::vector<std::filesystem::path> checked_, made_;
};
}
