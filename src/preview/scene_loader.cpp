#include "preview/scene_loader.h"

#include "base/parallel.h"

#include <chrono>
#include <new>

namespace tyndall {
namespace {
LoadedScene read(const std::filesystem::path& file, const LoadOptions& options) {
    flush_denormals();
    try {
        const auto begun = std::filesystem::file_time_type::clock::now();
        auto scene = std::make_shared<const Scene>(load_scene(file, options));
        FileTimes times = times_of(scene->inputs);
        for (auto& [input, time] : times)
            if (time > begun) time = std::filesystem::file_time_type::min();
        return {file, std::move(scene), std::move(times), {}, ExitCode::ok};
    } catch (const Error& error) {
        return {file, nullptr, {}, error.what(), error.code};
    } catch (const std::bad_alloc&) {
        return {file, nullptr, {}, file.string() + ": out of memory", ExitCode::out_of_memory};
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

FileTimes times_of(const std::vector<std::filesystem::path>& files) {
    FileTimes times;
    for (const std::filesystem::path& file : files) {
        std::error_code missing;
        const auto time = std::filesystem::last_write_time(file, missing);
        times[file] = missing ? std::filesystem::file_time_type::min() : time;
    }
    return times;
}
}
