// The ground truth: unbiased path tracing with multiple scattering in fog and on surfaces.
#include "integrate/lights/field_light.h"
#include "modes/mode.h"
#include "modes/path/limitations.h"
#include "modes/path/settings.h"
#include "modes/path/tracer.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "trace/lights/environment.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
bool has_emission(const PathTracer& tracer) {
    if (max_component(tracer.snapshot.ambient) > 0 || tracer.finds_sky || tracer.fire) return true;
    for (const Medium& medium : tracer.snapshot.media)
        if (max_component(medium.optics.emission.radiance) > 0) return true;
    if (tracer.surfaces_emit && tracer.snapshot.scene)
        for (const Material& material : tracer.snapshot.scene->materials)
            if (max_component(material.emission) > 0) return true;
    return false;
}

// Whether shadow rays and lines that leave the scene see the same environment light, so that MIS can combine both.
bool finds_sky(const Snapshot& snapshot) {
    return snapshot.environment && snapshot.environment->shadows && snapshot.environment->casters < 0;
}
}

ScatterFunction prepare_path(const View& view, const Snapshot& snapshot, const Settings& settings, History*) {
    auto tracer = std::make_shared<PathTracer>();
    TermSettings terms = settings.terms;
    tracer->ambient_in_fog = std::exchange(terms.ambient, true);
    tracer->snapshot = with_terms(snapshot, terms);
    tracer->settings = settings.path, tracer->surfaces_emit = terms.emission;
    tracer->camera = view.camera, tracer->size = view.size;
    tracer->chromatic = is_chromatic(tracer->snapshot);
    if (tracer->surfaces_emit) tracer->emitters = emissive_triangles(tracer->snapshot);
    tracer->fire = emissive_bricks(tracer->snapshot, Emitting::grids);
    take_fields(tracer->snapshot, settings.style, view.camera);
    tracer->finds_sky = finds_sky(tracer->snapshot);
    if (std::ranges::any_of(tracer->snapshot.lights, [](const Light& light) { return light.area != nullptr; }))
        for (const Medium& medium : tracer->snapshot.media) tracer->peaks.push_back(phase_peak(medium.optics.phase));
    tracer->has_emission = has_emission(*tracer);
    return [tracer](const RayBatch& batch, std::span<Scatter> results) { trace_paths(*tracer, batch, results); };
}

Mode path_mode() {
    return {.name = "path",
            .summary = "unbiased path tracing of all scattered light: the ground truth, with noise",
            .use = "clouds and thick fog, where light scatters many times, and checking the other modes",
            .accuracy = Accuracy::multiple_scattering,
            .surfaces = Surfaces::own,
            .limitations = path_limitations,
            .prepare = prepare_path,
            .append_rows = append_path_rows,
            .rungs = path_rungs,
            .color = "#000000",
            .traces_channels = true};
}
}
