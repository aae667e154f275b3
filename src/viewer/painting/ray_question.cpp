#include "viewer/painting/ray_question.h"

#include "base/clock.h"
#include "modes/mode.h"
#include "render/sequence/provenance.h"
#include "trace/view.h"
#include "viewer/painting/request.h"

namespace tyndall {
namespace {
constexpr int noisy_samples = 2048; // for modes whose error is noise: fast, and accurate to a few percent

bool is_of(const Request& request, const RayAnswer* answer) {
    return answer && request.explain && answer->revision == request.revision && answer->pixel == *request.explain;
}
}

bool asks_for_ray(const Request& request, const RayAnswer* answer) {
    return request.explain && !(is_of(request, answer) && answer->complete);
}

std::shared_ptr<const RayAnswer> answer_ray(const Request& request, const Snapshot& snapshot, const RayAnswer* before,
                                            std::atomic<bool>& cancel) {
    const double start = steady_seconds();
    auto answer = std::make_shared<RayAnswer>();
    answer->revision = request.revision, answer->pixel = *request.explain, answer->frame = request.frame;
    ExplainOptions options;
    options.noisy_samples = noisy_samples, options.cancel = &cancel;
    answer->complete = is_of(request, before);
    if (answer->complete)
        for (const Mode& mode : modes()) options.modes.push_back(&mode);
    answer->report = explain_ray(view_of(request), snapshot, request.settings, answer->pixel, options);
    answer->seconds = steady_seconds() - start;
    return answer;
}
}
