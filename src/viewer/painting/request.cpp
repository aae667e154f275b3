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

RenderRequest render_request(const Request& request) {
    RenderRequest result;
    result.frames = {request.frame};
    result.mode = request.mode, result.settings = request.settings;
    result.resolution = request.size, result.seed = request.seed, result.missing = request.missing;
    if (!request.scene) return result;
    result.scene_file = request.scene->file;
    if (shutter_of(*request.scene, result)) result.shutter = Shutter{}; // the viewer shows stills
    return result;
}

View view_of(const Request& request) {
    View view = view_of(*request.scene, render_request(request), request.settings, request.frame);
    view.camera = request.camera;
    return view;
}

void apply_edits(const Request& request) {
    if (request.edited) put_parts(*request.edited, *request.scene);
}
}
