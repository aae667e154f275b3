#include "viewer/editing/scene_loader.h"

#include "base/parallel.h"

#include <chrono>
#include <new>

namespace tyndall {
namespace {
LoadedScene read(const std::filesystem::path& file, const LoadOptions& options) {
    flush_denormals();
    try {
        using FileClock = std::filesystem::file_time_type::clock;
        const auto begun = FileClock::now();
        auto session = std::make_shared<SceneSession>(open_session(file, options));
        for (InputTime& input : session->inputs)
            if (input.written >= begun && input.written <= FileClock::now()) input.written = {};
        auto render_copy = std::make_shared<Scene>(session->scene);
        return {file, std::move(session), std::move(render_copy), {}, ExitCode::ok};
    } catch (const Error& error) {
        return {file, nullptr, nullptr, error.what(), error.code};
    } catch (const std::bad_alloc&) {
        return {file, nullptr, nullptr, file.string() + ": out of memory", ExitCode::out_of_memory};
    } catch (const std::exception& error) {
        return {file, nullptr, nullptr, file.string() + ": " + error.what(), ExitCode::internal};
    }
}
}

void SceneLoader::start(const std::filesystem::path& file, const LoadOptions& options, std::function<void()> done) {
    const auto is_done = [](const std::future<LoadedScene>& result) {
        return result.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    };
    if (result_.valid()) forgotten_.push_back(std::move(result_));
    std::erase_if(forgotten_, is_done);
    result_ = std::async(std::launch::async, [file, options, done = std::move(done)] {
        LoadedScene loaded = read(file, options);
        if (done) done();
        return loaded;
    });
}

std::optional<LoadedScene> SceneLoader::take() {
    if (!result_.valid() || result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
    return result_.get();
}
}
