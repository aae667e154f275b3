// Output paths of a command: checked before any work starts; a failed run leaves no directories behind.
#pragma once
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// Throws Error (usage) unless the pattern ends in `extension`, its frame token (if any) is valid, and it has one if
// there are `several` frames.
void check_pattern(const std::string& pattern, std::string_view extension, bool several,
                   std::string_view option = "--output");

// Checks that every file can be written. Directories it creates are removed again if they are empty at the end.
class OutputPaths {
public:
    ~OutputPaths();
    // Throws Error (unwritable).
    void check(const std::filesystem::path& file);
    void check(const std::string& pattern, const std::vector<int>& frames, std::string_view option = "--output");

    // Throws Error (usage) if a file checked before would overwrite this one.
    void spare(const std::filesystem::path& input) const;
    // The same for many files in one folder, of which none need exist.
    void spare_all(const std::vector<std::filesystem::path>& inputs) const;

private:
    std::vector<std::filesystem::path> checked_, made_; // folders
    std::set<std::filesystem::path> files_;
};
}
