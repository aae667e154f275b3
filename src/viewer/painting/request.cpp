#include "viewer/painting/request.h"

#include "modes/mode.h"
#include "render/sequence/job.h"
#include "render/sequence/provenance.h"
#include "trace/view.h"
#include "viewer/editing/editable_parts.h"

namespace tyndall {
const std::string& quick_mode(const Request& request) {
    return !find_mode(request.mode).interactive && !request.stand_in.empty() ? request.stand_in : request.mode;
}

RenderJob job_of(const Request& request) {
    RenderJob job;
    job.frames = {request.frame};
    job.mode = request.mode, job.settings = request.settings;
    job.resolution = request.size, job.seed = request.seed, job.missing = request.missing;
    if (request.scene) job.scene_file = request.scene->file;
    return job;
}

View view_of(const Request& request) {
    View view = view_of(*request.scene, job_of(request), request.frame);
    view.camera = request.camera;
    return view;
}

void stage(const Request& request) {
    if (request.edited) put_parts(*request.edited, *request.scene);
}
}
