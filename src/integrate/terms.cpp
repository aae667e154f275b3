#include "integrate/terms.h"

#include "integrate/style.h"
#include "trace/lights/environment.h"
#include "volume/medium.h"

namespace tyndall {
Snapshot with_terms(Snapshot snapshot, const TermSettings& terms) {
    if (!terms.heterogeneity) snapshot.media = homogeneous_media(snapshot.media);
    if (!terms.emission) std::erase_if(snapshot.media, [](const Medium& medium) { return only_emits(medium.optics); });
    for (Medium& medium : snapshot.media) {
        if (!terms.phase) medium.optics.phase = {PhaseKind::isotropic};
        if (!terms.emission) medium.optics.emission.radiance = vec3(0);
    }
    if (!terms.ambient) snapshot.ambient = vec3(0), snapshot.environment = nullptr;
    if (snapshot.moments) {
        auto moments = std::make_shared<std::vector<Snapshot>>();
        for (const Snapshot& moment : *snapshot.moments) moments->push_back(with_terms(moment, terms));
        snapshot.moments = std::move(moments);
    }
    return snapshot;
}

vec3 mean_ambient(const Snapshot& snapshot) {
    if (!snapshot.environment) return snapshot.ambient;
    return snapshot.ambient + snapshot.environment->mean() * snapshot.environment->volume_scale;
}

Snapshot with_mean_environment(Snapshot snapshot) {
    snapshot.ambient = mean_ambient(snapshot);
    return snapshot;
}
}
