#include "integrate/march_settings.h"

#include "integrate/style.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
void simplify(Medium& medium, const MarchSettings& settings) {
    if (!settings.phase) medium.optics.phase.kind = PhaseKind::isotropic;
    if (!settings.emission) medium.optics.emission = vec3(0);
}
}

Snapshot march_snapshot(const Snapshot& snapshot, const MarchSettings& settings, const StyleSettings& style) {
    Snapshot result = stylised(snapshot, style);
    if (!settings.heterogeneity) result.media = even_media(result.media);
    for (Medium& medium : result.media) simplify(medium, settings);
    if (!settings.ambient) result.ambient = vec3(0);
    return result;
}
}
