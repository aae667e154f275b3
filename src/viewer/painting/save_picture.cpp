#include "viewer/painting/save_picture.h"

#include "base/error.h"
#include "base/io/output.h"
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "render/frame/layers.h"
#include "render/image/png.h"
#include "render/sequence/auto_exposure.h"
#include "render/sequence/job.h"
#include "render/sequence/provenance.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "trace/view.h"

namespace tyndall {
void save_picture(const SaveJob& job, const Snapshot* previous, std::atomic<bool>& cancel,
                  const std::function<void(double)>& progress) {
    const std::string kind = job.file.extension().string();
    if (kind != ".exr" && kind != ".png")
        fail(ExitCode::usage, job.file.string(), "expected a name ending in .exr or .png");
    const Request& request = job.request;
    RenderRequest render = render_request(request);
    render.output = std::filesystem::path(job.file).replace_extension(".exr").string();
    render.quality = job.quality, render.isa = job.isa, render.light_units = job.light_units;
    render.unsaved = job.unsaved;
    render.png = kind == ".png";
    const RenderPlan plan = requested_plan(render);
    apply_edits(request);
    if (!job.inputs.empty()) request.scene->inputs = job.inputs;
    const View view = view_of(request);
    OutputPaths places;
    check_job(*request.scene, render, *plan.mode, places);
    render.camera = job.camera;

    Snapshot known;
    if (previous) known = *previous, set_extent(*request.scene, known); // of the scene as edited
    const Snapshot snapshot = make_snapshot(*request.scene, moment_of(*request.scene, request.frame),
                                            previous ? &known : nullptr, request.missing);
    FrameStats stats;
    FrameOptions options;
    options.cancel = &cancel, options.progress = progress;
    const Layers layers = render_frame(*plan.mode, view, snapshot, plan.settings, options, stats);
    if (kind == ".png") {
        Display display = request.shown.display();
        if (!request.shown.exposure)
            display.exposure = automatic_exposure(*request.scene, render, orders_of(*plan.mode, plan.settings),
                                                  &snapshot, &request.camera);
        return write_png(job.file, stored_color(layers, render.exr), display);
    }
    FileHashes files;
    const std::string hash = frame_hash(*request.scene, render, plan, view, files);
    const Provenance provenance = provenance_of(*request.scene, render, plan, view, hash, stats);
    write_exr(job.file, layers, provenance, render.exr);
}
}
