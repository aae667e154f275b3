#include "trace/shadows/cached_shadows.h"
#include "trace/frame_cache.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
CacheKey shadow_key(const Snapshot& snapshot, const Light& light) {
    CacheKey key;
    key.add(shadow_casters(light, snapshot)).add(light);
    return key;
}

}

std::shared_ptr<const ShadowMesh> cached_shadow_mesh(const Snapshot& snapshot, const Light& light) {
    return *cached(snapshot, "shadow mesh", shadow_key(snapshot, light),
                   [&] { return mesh_in_reach(shadow_casters(light, snapshot)->shadow_mesh(), light); });
}

std::shared_ptr<const ShadowMap> cached_shadow_map(const View& view, const Snapshot& snapshot, const Light& light,
                                                   const ShadowMapOptions& options) {
    Box fog; // all of the media that shadow maps depend on
    for (const Medium& medium : snapshot.media) fog.grow(medium.world_bounds);
    CacheKey key = shadow_key(snapshot, light);
    key.add(view).add(fog).add(snapshot.bounds).add(snapshot.anchor).add(snapshot.extent);
    key.add(options.resolution).add(options.cascades).add(options.pcf).add(options.bias);
    return cached(snapshot, "shadow map", std::move(key),
                  [&] { return make_shadow_map(view, snapshot, light, options); });
}

std::shared_ptr<const ShadowVolumes> cached_shadow_volumes(const Snapshot& snapshot, const Light& light, dvec3 off) {
    CacheKey key = shadow_key(snapshot, light);
    return cached(snapshot, "shadow volumes", std::move(key.add(off)), [&] {
        std::shared_ptr<const ShadowMesh> mesh = cached_shadow_mesh(snapshot, light);
        const LightPoint point = visible_point(*mesh, center_of(light), off);
        return make_shadow_volumes(std::move(mesh), point, shadow_cone(light));
    });
}

bool has_room_for_views(const Snapshot& snapshot, const std::function<size_t(const Light&)>& views) {
    size_t triangles = 0;
    for (const Light& light : snapshot.lights)
        if (const size_t count = shadow_casters(light, snapshot) ? views(light) : 0)
            triangles += count * cached_shadow_mesh(snapshot, light)->triangles.size();
    return triangles * bytes_per_shadow_triangle <= max_bytes_of_shadows;
}

std::shared_ptr<const ShadowView> cached_shadow_view(const Snapshot& snapshot, const Light& light, const View& view,
                                                     float margin, dvec3 off) {
    CacheKey key = shadow_key(snapshot, light);
    return cached(snapshot, "shadow view", std::move(key.add(view).add(margin).add(off)), [&] {
        return view_from(*cached_shadow_volumes(snapshot, light, off), view.camera, view.size, margin);
    });
}
}
