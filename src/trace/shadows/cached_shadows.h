// Shadows of a snapshot's lights, made once while all they depend on stands still (trace/frame_cache.h).
#pragma once
#include "trace/shadows/maps/shadow_map.h"
#include "trace/shadows/volumes/shadow_view.h"

#include <functional>

namespace tyndall {
using ShadowMaps = std::vector<std::shared_ptr<const ShadowMap>>;

// As make_shadow_map().
std::shared_ptr<const ShadowMap> cached_shadow_map(const View& view, const Snapshot& snapshot, const Light& light,
                                                   const ShadowMapOptions& options);

// What may shadow anything that the light reaches.
std::shared_ptr<const ShadowMesh> cached_shadow_mesh(const Snapshot& snapshot, const Light& light);

// Of the light's centre, or of a point so far off it. Surfaces shadow the light.
std::shared_ptr<const ShadowVolumes> cached_shadow_volumes(const Snapshot& snapshot, const Light& light,
                                                           dvec3 off = dvec3(0));

// What a triangle takes in the shadow volumes of a light, and in each view of them; and what those of all lights may.
inline constexpr size_t bytes_per_shadow_triangle = 200, max_bytes_of_shadows = size_t{1} << 30;

// Whether the shadows of all lights as cameras see them fit in that; `views`: how many of a light are wanted.
bool has_room_for_views(const Snapshot& snapshot, const std::function<size_t(const Light&)>& views);

// The same as the view's camera sees them; see view_from().
std::shared_ptr<const ShadowView> cached_shadow_view(const Snapshot& snapshot, const Light& light, const View& view,
                                                     float margin, dvec3 off = dvec3(0));
}
