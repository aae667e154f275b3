#include "render/farm/inputs.h"

#include "base/io/file_hashes.h"
#include "render/sequence/job.h"
#include "scene/input_files.h"
#include "scene/scene.h"

#include <set>

namespace tyndall {
std::vector<std::filesystem::path> input_files(const Scene& scene, const std::vector<int>& frames,
                                               const RenderRequest& request) {
    std::set<std::filesystem::path> files;
    const auto add = [&](const std::filesystem::path& file) { files.insert(normal_path(file)); };
    for (const InputFile& input : scene.inputs) add(input.path);
    for (const int frame : frames)
        for (const FrameFile& file : frame_files(scene, frame, request.missing, shutter_of(scene, request)))
            if (file.path) add(*file.path);
    return {files.begin(), files.end()};
}
}
