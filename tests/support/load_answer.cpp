#include "support/load_answer.h"

#include <gtest/gtest.h>

namespace tyndall {
LoadResult load(const std::filesystem::path& file, const LoadOptions& options) {
    LoadResult answer;
    try {
        answer.scene = load_scene(file, options);
        answer.loaded = true;
    } catch (const Error& error) {
        answer.code = error.code;
        answer.message = error.what();
    }
    return answer;
}

void expect_one_line(const std::string& message) {
    EXPECT_LE(message.size(), 500u) << message;
    EXPECT_FALSE(message.empty());
    for (const unsigned char c : message) EXPECT_TRUE(c >= 0x20 && c != 0x7f) << message;
}

void expect_refusal(const LoadResult& answer, std::string_view part, ExitCode code) {
    EXPECT_FALSE(answer.loaded) << "loaded, but should name " << part;
    EXPECT_EQ(static_cast<int>(answer.code), static_cast<int>(code)) << answer.message;
    EXPECT_NE(answer.message.find(part), std::string::npos) << answer.message;
    expect_one_line(answer.message);
}

bool has_warning(const Scene& scene, std::string_view part) {
    for (const std::string& warning : scene.warnings)
        if (warning.find(part) != std::string::npos) return true;
    return false;
}
}
