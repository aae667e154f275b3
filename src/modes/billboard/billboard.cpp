// Beam cards: an artistic effect. Textured quads are drawn where light leaks into the scene.
#include "modes/billboard/billboard.h"
#include "modes/billboard/limitations.h"
#include "modes/billboard/settings.h"

#include "modes/lens_fog.h"
#include "modes/mode.h"
#include "scene/light.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
ScatterFunction prepare_billboard(const View& view, const Snapshot& snapshot, const Settings& settings, History*) {
    const auto billboards = std::make_shared<const Billboards>(make_billboards(view, snapshot, settings));
    return through_middle(view, [billboards](const RayBatch& batch, std::span<Scatter> results) {
        billboard_packet(*billboards, batch, results);
    });
}

Mode billboard_mode() {
    return {.name = "billboard",
            .summary = "textured beam cards where light leaks into the scene: artistic, not light transport",
            .use = "beams as an effect, placed and tinted by hand; no setting makes them converge",
            .accuracy = Accuracy::artistic,
            .surfaces = Surfaces::shared,
            .limitations = billboard_limitations,
            .prepare = prepare_billboard,
            .append_rows = append_billboard_rows,
            .rungs = billboard_rungs,
            .color = "#B8A900",
            .interactive = true};
}
}
