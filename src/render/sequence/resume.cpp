// Frames are judged by their content, not by date and not by the header alone.
#include "render/sequence/resume.h"

#include "base/error.h"

#include <algorithm>

namespace tyndall {
namespace {
std::vector<std::string> names_of(const ExrFile& exr) {
    std::vector<std::string> names;
    for (const auto& channel : exr.channels) names.push_back(channel.first);
    std::ranges::sort(names);
    return names;
}

std::string difference(const ExrFile& exr, const ExpectedFrame& expected) {
    const auto hash = exr.attributes.find("tyndall:hash");
    if (hash == exr.attributes.end()) return "its header lacks tyndall:hash";
    if (exr.display != expected.display || exr.low != expected.low || exr.size != expected.size)
        return "its size differs";
    if (names_of(exr) != expected.channels) return "its layers differ";
    if (hash->second != expected.hash) return "scene, fog or settings have changed";
    if (!exr.is_unchanged) return "its contents do not match its checksum";
    return {};
}
}

std::optional<ExrFile> finished_frame(const std::filesystem::path& file, const ExpectedFrame& expected,
                                      std::string& why) {
    why.clear();
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(file, error))) return {};
    try {
        ExrFile exr = read_exr(file);
        why = difference(exr, expected);
        if (why.empty()) return exr;
    } catch (const Error& problem) {
        why = problem.what();
    }
    return {};
}
}
