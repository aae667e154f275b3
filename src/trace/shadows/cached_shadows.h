// Shadows of a snapshot's lights, cached while their inputs do not change (trace/frame_cache.h).
#pragma once
#include "trace/shadows/maps/shadow_map.h"
#include "trace/shadows/volumes/shadow_view.h"

#include <functional>

namespace tyndall {
using ShadowMaps = std::vector<std::shared_ptr<const ShadowMap>>;

// Cached make_shadow_map().
std::shared_ptr<const ShadowMap> cached_shadow_map(const View& view, const Snapshot& snapshot, const Light& light,
                                                   const ShadowMapOptions& options);

// The triangles that may shadow anything the light reaches.
std::shared_ptr<const ShadowMesh> cached_shadow_mesh(const Snapshot& snapshot, const Light& light);

// Shadow volumes of the light's center, or of visible_point() at `off` from it. The light must have shadow casters.
std::shared_ptr<const ShadowVolumes> cached_shadow_volumes(const Snapshot& snapshot, const Light& light,
                                                           dvec3 off = dvec3(0));

// Bytes per triangle of a light's shadow volumes and of each view of them; and the limit over all lights.
inline constexpr size_t bytes_per_shadow_triangle = 200, max_bytes_of_shadows = size_t{1} << 30;

// Whether camera views of the shadow volumes of all lights fit the limit; `views`: how many a light needs.
bool has_room_for_views(const Snapshot& snapshot, const std::function<size_t(const Light&)>& views);

// cached_shadow_volumes() as seen by the view's camera; see view_from().
std::shared_ptr<const ShadowView> cached_shadow_view(const Snapshot& snapshot, const Light& light, const View& view,
                                                     float margin, dvec3 off = dvec3(0));
}
