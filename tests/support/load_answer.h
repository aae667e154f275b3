// What loading a scene file answers, and checks of refusals.
#pragma once
#include "base/error.h"
#include "scene/load_options.h"
#include "scene/scene.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace tyndall {
// What loading a file answers: the scene, or one line of refusal.
struct LoadResult {
    Scene scene;
    bool loaded = false;
    ExitCode code = ExitCode::ok;
    std::string message;
};

LoadResult load(const std::filesystem::path& file, const LoadOptions& options = {});

// A refusal is one short printable line.
void expect_one_line(const std::string& message);

void expect_refusal(const LoadResult& answer, std::string_view part, ExitCode code = ExitCode::refused);

bool has_warning(const Scene& scene, std::string_view part);
}
