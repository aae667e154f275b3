#include "viewer/painting/file_job.h"

#include "base/io/frames.h"
#include "base/io/output.h"
#include "base/io/progress.h"
#include "base/text.h"
#include "render/sequence/provenance.h"
#include "render/sequence/sequence.h"
#include "trace/moment.h"
#include "viewer/editing/scene_session.h"
#include "volume/recipe/bake.h"
#include "volume/vdb/vdb.h"

#include <algorithm>
#include <new>

namespace tyndall {
namespace {
std::vector<int> frames_of(const Scene& scene, const std::string& range) {
    return range.empty() ? frames_between(scene.first_frame, scene.last_frame) : parse_frames(range);
}

// Adds the camera moved by hand to the scene, under an unused name.
std::string add_camera(Scene& scene, const Viewpoint& view) {
    CameraSource source;
    source.name = "view";
    const auto taken = [&](const CameraSource& camera) { return camera.name == source.name; };
    while (std::ranges::any_of(scene.cameras, taken)) source.name += "'";
    const Camera& camera = view.camera;
    source.position = {camera.position}, source.target = {view.target()}, source.up = {camera.up};
    source.vertical_fov = {camera.vertical_fov}, source.ortho_height = camera.ortho_height;
    source.near = camera.near, source.far = camera.far;
    source.aperture = {camera.lens.radius}, source.focus = {camera.lens.focus};
    source.blades = camera.lens.blades, source.blade_rotation = {camera.lens.rotation};
    scene.cameras.push_back(source);
    return source.name;
}

std::string frames_done(int done, int of) { return formatted("%d of %s", done, count_text(of, "frame").c_str()); }

JobResult render(const RenderJob& files, Progress& progress, std::atomic<bool>& cancel) {
    const RenderRequest& request = files.request;
    const RenderReport report = render_sequence(*files.scene, request, requested_plan(request), progress, cancel);
    const int done = static_cast<int>(report.frames.size()), all = static_cast<int>(request.frames.size());
    if (report.cancelled) return {"stopped: " + frames_done(done, all) + " are finished: " + request.output};
    progress.finish();
    const int kept = static_cast<int>(std::ranges::count_if(report.frames, &FrameReport::kept));
    std::string text = count_text(done - kept, "frame") + " rendered in " + seconds_text(report.seconds);
    if (kept > 0) text += formatted(", %d kept", kept);
    text += ": " + request.output;
    for (const std::string& note : report.notes) text += "; " + note;
    if (report.non_finite == 0) return {text};
    return {text + "; " + count_text(report.non_finite, "sample") + " were not finite numbers and were ignored",
            ExitCode::non_finite};
}

JobResult bake_fog(const BakeJob& files, Progress& progress, std::atomic<bool>& cancel) {
    BakeOptions options;
    options.resume = true, options.cancel = &cancel;
    const BakeReport report = bake(files.recipe, files.output, files.frames, options, progress);
    const int done = report.written + report.kept;
    if (report.cancelled)
        return {"stopped: " + frames_done(done, static_cast<int>(files.frames.size())) +
                " are finished: " + files.output};
    progress.finish();
    std::string text = count_text(report.written, "frame") + " baked in " + seconds_text(report.seconds);
    if (report.kept > 0) text += formatted(", %d kept", report.kept);
    return {text + ": " + files.output};
}
}

RenderRequest sequence_request(const ViewState& state, const std::string& output, const std::string& range, bool png,
                               const std::string& isa) {
    const Scene& scene = loaded_scene(state);
    RenderRequest request;
    request.frames = frames_of(scene, range);
    check_pattern(output, ".exr", request.frames.size() > 1, "render");
    request.scene_file = scene.file, request.output = output;
    request.mode = state.mode, request.quality = state.quality, request.settings = state.settings,
    request.camera = state.camera;
    request.resolution = state.size, request.seed = state.seed, request.missing = state.missing;
    if (!shows_scene_exposure(state)) request.exposure = exposure_now(state);
    request.automatic_exposure = !request.exposure && !shows_scene_exposure(state);
    request.view_transform = state.shown.transform;
    request.light_units = state.session->options.light_units, request.isa = isa;
    request.png = png, request.resume = true;
    request.unsaved = unsaved_text(*state.session);
    return request;
}

RenderJob render_job(const ViewState& state, RenderRequest request) {
    auto scene = std::make_shared<Scene>(loaded_scene(state));
    if (state.free_camera) request.camera = add_camera(*scene, state.view);
    return {std::move(scene), std::move(request)};
}

std::vector<std::string> bakeable_media(const Scene& scene) {
    std::vector<std::string> names;
    for (const MediumSource& medium : scene.media)
        if (medium.recipe) names.push_back(medium.name);
    return names;
}

BakeJob bake_job(const ViewState& state, const std::string& medium, const std::string& output,
                 const std::string& range) {
    const Scene& scene = loaded_scene(state);
    const auto found =
        std::ranges::find_if(scene.media, [&](const MediumSource& one) { return one.recipe && one.name == medium; });
    if (found == scene.media.end())
        fail(ExitCode::usage, "bake", unknown_name("medium made from a recipe", medium, bakeable_media(scene)));
    BakeJob files{*found->recipe, output, frames_of(scene, range)};
    check_pattern(output, ".vdb", files.frames.size() > 1, "bake");
    if (found->voxel_size > 0) files.recipe.voxel_size = found->voxel_size;
    files.recipe.frame_rate = scene.frame_rate;
    const double seconds = moment_of(scene, files.frames.front()).seconds;
    files.recipe.extinction = found->extinction.at(seconds), files.recipe.albedo = found->albedo.at(seconds);
    files.recipe.g =
        std::clamp(mean_cosine(phase_at(found->phase, found->g.at(seconds), seconds)), -largest_g, largest_g);
    return files;
}

std::string command_of(const ViewState& state, RenderRequest request) {
    const Scene& scene = loaded_scene(state);
    if (!request.unsaved.empty() || (!state.session->has_file && is_volume_name(scene.file)))
        fail(ExitCode::usage, "copy-command", "what is shown is not in a scene file: save the scene first");
    if (state.free_camera)
        fail(ExitCode::usage, "copy-command",
             "the camera moved by hand is not in a scene file: copy it into the scene, or go back to one of the "
             "scene's (home)");
    request.scene_file = std::filesystem::absolute(request.scene_file);
    request.output = std::filesystem::absolute(request.output).string();
    return command_line(request);
}

std::string name_of(const FileJob& job) {
    if (const auto* files = std::get_if<RenderJob>(&job)) return "render " + files->request.output;
    return "bake " + std::get<BakeJob>(job).output;
}

int frame_count(const FileJob& job) {
    const auto* files = std::get_if<RenderJob>(&job);
    return static_cast<int>(files ? files->request.frames.size() : std::get<BakeJob>(job).frames.size());
}

JobResult run_job(const FileJob& job, Progress& progress, std::atomic<bool>& cancel) {
    const auto* files = std::get_if<RenderJob>(&job);
    try {
        if (files) return render(*files, progress, cancel);
        const BakeJob& fog = std::get<BakeJob>(job);
        OutputPaths places;
        places.check(fog.output, fog.frames, "bake");
        return bake_fog(fog, progress, cancel);
    } catch (const Error& error) {
        return {error.what(), error.code};
    } catch (const std::bad_alloc&) {
        return {"out of memory", ExitCode::out_of_memory};
    } catch (const std::exception& error) {
        return {error.what(), ExitCode::internal};
    }
}

std::string default_sequence_name(const ViewState& state) {
    return loaded_scene(state).file.stem().string() + "." + state.mode + ".####.exr";
}

std::string default_bake_name(const std::string& medium) {
    std::string name = medium;
    std::ranges::replace_if(
        name, [](unsigned char letter) { return !std::isalnum(letter) && letter != '-'; }, '_');
    return name + ".####.vdb";
}
}
