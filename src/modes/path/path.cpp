// The truth: unbiased path tracing of light that scatters any number of times, in fog and on surfaces.
#include "modes/mode.h"
#include "modes/path/limitations.h"
#include "modes/path/settings.h"
#include "modes/path/tracer.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
bool glimmers(const PathTracer& tracer) {
    if (max_component(tracer.snapshot.ambient) > 0) return true;
    for (const Medium& medium : tracer.snapshot.media)
        if (max_component(medium.optics.emission) > 0) return true;
    if (tracer.settings.emission && tracer.snapshot.scene)
        for (const Material& material : tracer.snapshot.scene->materials)
            if (max_component(material.emission) > 0) return true;
    return false;
}
}

ScatterFunction prepare_path(const View& view, const Snapshot& snapshot, const Settings& settings, History*) {
    auto tracer = std::make_shared<PathTracer>();
    tracer->snapshot = snapshot;
    tracer->settings = settings.path;
    tracer->camera = view.camera, tracer->size = view.size;
    if (!settings.path.ambient) tracer->snapshot.ambient = vec3(0);
    if (!settings.path.emission)
        for (Medium& medium : tracer->snapshot.media) medium.optics.emission = vec3(0);
    if (settings.path.emission) tracer->glow = make_glow(tracer->snapshot);
    tracer->glimmers = glimmers(*tracer);
    return [tracer](const RayBatch& batch, std::span<Scatter> results) { trace_paths(*tracer, batch, results); };
}

Mode path_mode() {
    return {.name = "path",
            .summary = "unbiased path tracing of all scattered light: the truth, with noise",
            .accuracy = Accuracy::multiple_scattering,
            .surfaces = Surfaces::own,
            .limitations = path_limitations,
            .prepare = prepare_path,
            .append_rows = append_path_rows,
            .rungs = path_rungs,
            .color = "#000000"};
}
}
