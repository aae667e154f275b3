#include "integrate/style.h"
#include "scene/light.h"
#include "trace/lights/environment.h"
#include "volume/bricks/bricks.h"
#include "volume/emission/emission_field.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
Medium at_mean_density(const Medium& medium) {
    if (medium.density.kind != DensityKind::bricks) return medium;
    Medium even = medium;
    even.density.kind = DensityKind::homogeneous;
    even.density.bounds = medium.density.bricks->bounds;
    even.density.world_to_local = mat4(1);
    even.world_bounds = medium.density.bricks->bounds;
    even.optics.extinction *= medium.density.bricks->mean;
    even.optics.emission.radiance *= medium.density.bricks->mean;
    even.optics.emission.field = nullptr, even.optics.albedo_field = nullptr;
    even.density.bricks = nullptr;
    return even;
}

// Removes media without extinction, which a snapshot must not contain.
void drop_clear(std::vector<Medium>& media) {
    std::erase_if(media, [](const Medium& medium) { return !(gray_extinction(medium.optics) > 0); });
}

// All media do but fields that emit independently of what absorbs.
bool follows_density(const Optics& optics) { return !only_emits(optics) || optics.emission.field->absorber; }
}

bool is_stylized(const StyleSettings& a) {
    const StyleSettings b;
    return a.light_depth != b.light_depth || a.view_depth != b.view_depth || a.density != b.density ||
           a.range != b.range || a.tint != b.tint;
}

Snapshot stylized(const Snapshot& snapshot, const StyleSettings& style) {
    Snapshot result = snapshot;
    for (Medium& medium : result.media) {
        const float factor = follows_density(medium.optics) ? style.density : 1.0f;
        medium.optics.extinction *= factor;
        medium.optics.emission.radiance *= factor * style.tint;
        medium.optics.emission.scale *= factor * style.tint;
    }
    drop_clear(result.media);
    for (Light& light : result.lights) light.intensity *= style.tint;
    result.ambient *= style.tint;
    if (result.environment && style.tint != vec3(1)) {
        auto tinted = std::make_shared<Environment>(*result.environment);
        tinted->scale *= style.tint;
        result.environment = tinted;
    }
    return result;
}

std::vector<Medium> homogeneous_media(std::span<const Medium> media) {
    std::vector<Medium> result;
    for (const Medium& medium : media) result.push_back(at_mean_density(medium));
    drop_clear(result);
    return result;
}
}
