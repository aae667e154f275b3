// Reads scene files in the background, and again when one of their files has changed.
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
    std::shared_ptr<SceneSession> session; // null if reading failed; files written meanwhile count as changed
    std::shared_ptr<Scene> render_copy;    // a copy of its scene for the render thread
    std::string error;
    ExitCode code = ExitCode::ok;
};

class SceneLoader {
public:
    // Starts reading a file; abandons a read that is in progress. `done` is called from another thread.
    void start(const std::filesystem::path& file, const LoadOptions& options, std::function<void()> done = {});
    bool loading() const { return result_.valid(); }
    std::optional<LoadedScene> take(); // the scene that was read, once

private:
    std::future<LoadedScene> result_;
    std::vector<std::future<LoadedScene>> forgotten_; // not yet done
};

}
