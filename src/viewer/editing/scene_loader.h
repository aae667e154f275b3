// Scene files read beside everything else, and read again when one of their files has changed.
#pragma once
#include "base/error.h"
#include "viewer/editing/scene_session.h"

#include <functional>
#include <future>
#include <memory>
#include <optional>

namespace tyndall {
struct LoadedScene {
    std::filesystem::path file;
    std::shared_ptr<SceneSession> session; // null when it could not be read; files written meanwhile count as changed
    std::shared_ptr<Scene> stage;          // a copy of its scene for the thread that renders
    std::string error;
    ExitCode code = ExitCode::ok;
};

class SceneLoader {
public:
    // Begins to read a file; what is being read at that time is forgotten. `done` is called from another thread.
    void start(const std::filesystem::path& file, const LoadOptions& options, std::function<void()> done = {});
    bool loading() const { return result_.valid(); }
    std::optional<LoadedScene> take(); // what was read, once

private:
    std::future<LoadedScene> result_;
    std::vector<std::future<LoadedScene>> forgotten_; // not yet done
};

}
