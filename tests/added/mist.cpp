// A technique that only the tests have: fog of one brightness.
#include "integrate/homogeneous_fog.h"
#include "integrate/style.h"
#include "modes/mode.h"
#include "modes/settings_rows.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
struct MistSettings {
    float brightness = 1; // radiance of fog that nothing shines through
};

constexpr LimitationKind blind{"mist_blind", "no light is looked at"};

Limitations limitations(const View&, const Snapshot&, const Settings&) {
    return {{Severity::wrong, &blind, Subject::image}};
}

ScatterFunction prepare(const View&, const Snapshot& snapshot, const Settings& settings, History*) {
    return [dimmed = dimming_only(homogeneous_media(snapshot.media)),
            brightness = settings.of<MistSettings>().brightness](const RayBatch& batch, std::span<Scatter> results) {
        dimmed(batch, results);
        for (Scatter& result : results) result.radiance = vec3(brightness * (1 - result.transmittance));
    };
}

void append_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("mist.brightness", "nits", 0, 1e6, "radiance of fog that nothing shines through",
                              TYNDALL_FIELD(of<MistSettings>().brightness)));
}

void set_quality(Settings& settings, Quality quality) {
    if (quality == Quality::draft) settings.of<MistSettings>().brightness = 0.5f;
}

std::vector<Rung> rungs() {
    std::vector<Rung> result;
    for (const char* brightness : {"0.25", "0.5", "0.75", "1", "1.5", "2"})
        result.push_back({"", "pixel.samples=1 mist.brightness=" + std::string(brightness)});
    return result;
}
}

Mode mist_mode() {
    return {.name = "mist",
            .summary = "fog of one brightness",
            .use = "testing that the table is all there is to a technique",
            .accuracy = Accuracy::homogeneous,
            .surfaces = Surfaces::shared,
            .limitations = limitations,
            .prepare = prepare,
            .append_rows = append_rows,
            .set_quality = set_quality,
            .rungs = rungs,
            .color = "#888888",
            .interactive = true};
}
}
