#include "base/control_group.h"

#include <filesystem>
#include <fstream>

namespace tyndall {
namespace {
std::string first_line(const std::filesystem::path& path) {
    std::ifstream stream(path);
    std::string line;
    std::getline(stream, line);
    return line;
}

// Path of this process's cgroup in the v2 hierarchy, from a line such as "0::/batch/job_7".
std::string control_group() {
    std::ifstream stream("/proc/self/cgroup");
    for (std::string line; std::getline(stream, line);)
        if (line.starts_with("0::/")) return line.substr(4);
    return {};
}
}

std::vector<std::string> control_group_lines(const std::string& file) {
    std::vector<std::string> lines;
    for (std::filesystem::path group = control_group();; group = group.parent_path()) {
        lines.push_back(first_line(std::filesystem::path("/sys/fs/cgroup") / group / file));
        if (group.empty()) return lines;
    }
}
}
