#include "render/sequence/check_job.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/io/frames.h"
#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "render/sequence/job.h"
#include "scene/scene.h"
#include "trace/moment.h"

#include <set>

namespace tyndall {
namespace {
constexpr int largest_side = 16384; // what read_exr takes back

void check_picture(const Scene& scene, const RenderJob& job) {
    const ivec2 size = job.resolution.x > 0 ? job.resolution : scene.resolution;
    if (size.x < 1 || size.y < 1 || size.x > largest_side || size.y > largest_side)
        fail(ExitCode::usage, "resolution", "expected 1 to 16384 pixels on each side");
    const ivec2 low = job.crop_low, high = job.crop_high;
    if (low == high) return;
    if (low.x < 0 || low.y < 0 || low.x >= high.x || low.y >= high.y || high.x > size.x || high.y > size.y)
        fail(ExitCode::usage, "crop", "it has to lie inside the picture and hold a pixel");
}

// Names, directories and leftovers.
// Without links and dots, as far as the file system lets one look.
std::filesystem::path plain_path(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path plain = std::filesystem::weakly_canonical(path, error);
    return error ? path : plain;
}

void check_outputs(const Scene& scene, const RenderJob& job) {
    if (job.frames.empty()) fail(ExitCode::usage, "frames", "there is nothing to render");
    if (std::filesystem::path(job.output).extension() != ".exr")
        fail(ExitCode::usage, printable(job.output), "the output has to end in .exr");
    if (job.frames.size() > 1 && !has_frame_token(job.output))
        fail(ExitCode::usage, printable(job.output), "several frames need a place for the number, as in name.####.exr");

    std::set<std::filesystem::path> inputs, directories;
    for (const std::filesystem::path& input : scene.inputs) inputs.insert(plain_path(input));
    for (const int frame : job.frames) {
        const std::string exr = frame_name(job.output, frame);
        std::vector<std::filesystem::path> outputs{exr};
        if (job.png) outputs.push_back(png_name(exr));
        for (const std::filesystem::path& output : outputs) {
            if (inputs.contains(plain_path(output)))
                fail(ExitCode::usage, output.string(), "this file belongs to the scene and would be written over");
            check_output(output);
            directories.insert(output.has_parent_path() ? output.parent_path() : ".");
        }
    }
    for (const std::filesystem::path& directory : directories) sweep_temporaries(directory);
}
}

void check_job(const Scene& scene, const RenderJob& job, const Mode& mode) {
    check_layer_names(job.exr);
    check_picture(scene, job);
    find_camera(scene, job.camera);
    if (job.time_budget > 0) check_target(mode, "--time-budget");
    if (job.target_error > 0) check_target(mode);
    if (mode.surfaces == Surfaces::post && measures_noise(job))
        fail(ExitCode::usage, "--aov",
             std::string(mode.name) + " works on the finished picture: it has no variance and no halves");
    check_outputs(scene, job);
}
}
