#include "base/io/output.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/io/frames.h"

#include <algorithm>

namespace tyndall {
namespace fs = std::filesystem;

namespace {
// The path without links and dots, as far as the file system can be read.
fs::path plain_path(const fs::path& path) {
    std::error_code error;
    const fs::path plain = fs::weakly_canonical(path, error);
    return error ? path : plain;
}
}

void check_pattern(const std::string& pattern, std::string_view extension, bool several, std::string_view option) {
    const fs::path name = fs::path(pattern).filename();
    if (name.extension() != extension || name.stem().empty())
        fail(ExitCode::usage, option,
             "expected a name ending in " + std::string(extension) + ", like out.####" + std::string(extension) +
                 "; got '" + printable(pattern, 60) + "'");
    const bool numbered = has_frame_token(pattern);
    if (several && !numbered)
        fail(ExitCode::usage, option,
             "several frames need a frame number in the name, like " + name.stem().string() + ".####" +
                 std::string(extension));
}

OutputPaths::~OutputPaths() {
    // remove() only succeeds on empty directories; anything else in them is a user's work.
    for (auto made = made_.rbegin(); made != made_.rend(); ++made) {
        std::error_code ignored;
        fs::remove(*made, ignored);
    }
}

void OutputPaths::check(const fs::path& file) {
    files_.insert(plain_path(file));
    std::error_code ignored;
    const fs::path directory = file.parent_path();
    const bool seen = std::find(checked_.begin(), checked_.end(), directory) != checked_.end();
    if (seen && !fs::is_directory(file, ignored)) return;

    std::vector<fs::path> missing;
    for (fs::path place = directory; !place.empty() && !fs::exists(place, ignored); place = place.parent_path())
        missing.push_back(place);
    made_.insert(made_.end(), missing.rbegin(), missing.rend());
    check_output(file);
    checked_.push_back(directory);
    sweep_temporaries(directory.empty() ? fs::path(".") : directory);
}

void OutputPaths::check(const std::string& pattern, const std::vector<int>& frames, std::string_view option) {
    std::vector<std::string> names;
    for (const int frame : frames) names.push_back(frame_name(pattern, frame));
    for (const std::string& name : names) check(fs::path(name));
    std::sort(names.begin(), names.end());
    const auto twice = std::adjacent_find(names.begin(), names.end());
    if (twice != names.end())
        fail(ExitCode::usage, option, "two frames would be written to '" + printable(*twice, 100) + "'");
}

void OutputPaths::spare(const fs::path& input) const { spare_all({input}); }

void OutputPaths::spare_all(const std::vector<fs::path>& inputs) const {
    if (inputs.empty()) return;
    const fs::path parent = inputs.front().parent_path(), folder = plain_path(parent.empty() ? "." : parent);
    for (const fs::path& input : inputs) {
        std::error_code ignored;
        const bool is_link = fs::is_symlink(input, ignored);
        if (files_.contains(is_link ? plain_path(input) : folder / input.filename()))
            fail(ExitCode::usage, input.string(), "is read by this command and would be overwritten");
    }
}
}
