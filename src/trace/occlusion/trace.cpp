// Traces rays in packets as wide as the device supports, checked before Embree sees them.
#include "trace/occlusion/scene.h"

#include <cstring>

namespace tyndall {
namespace {
bool in_range(float value) { return std::abs(value) <= largest_coordinate; } // false for NaN
bool in_range(vec3 v) { return in_range(v.x) && in_range(v.y) && in_range(v.z); }

// Writes a ray to lane `i` of a packet; false if the ray is invalid.
template<class Packet> bool put_ray(const Ray& ray, float t_min, Packet& packet, int i, uint32_t id) {
    if (!in_range(ray.origin) || !in_range(ray.direction) || !(ray.t_max >= t_min) || !(t_min >= 0)) return false;
    packet.org_x[i] = ray.origin.x, packet.org_y[i] = ray.origin.y, packet.org_z[i] = ray.origin.z;
    packet.dir_x[i] = ray.direction.x, packet.dir_y[i] = ray.direction.y, packet.dir_z[i] = ray.direction.z;
    packet.tnear[i] = t_min, packet.tfar[i] = ray.t_max, packet.time[i] = 0;
    packet.mask[i] = ~0u, packet.id[i] = id, packet.flags[i] = 0;
    return true;
}

// Traces lanes [base, base + width) against one set; stores hits that are closer than those in `hits`.
template<class Packet, int width>
void trace_closest(const OccluderSet& set, std::span<const Ray> rays, float t_min, int base, bool coherent,
                   Hits& hits) {
    Packet packet;
    alignas(64) int valid[width];
    for (int i = 0; i < width; ++i) {
        const size_t lane = base + i;
        packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        valid[i] = 0;
        if (lane >= rays.size()) continue;
        Ray ray = rays[lane];
        if (hits.instance[lane] >= 0) ray.t_max = hits.t[lane];
        valid[i] = put_ray(ray, t_min, packet.ray, i, static_cast<uint32_t>(lane)) ? -1 : 0;
    }
    QueryContext context;
    intersect(set.scene, valid, context, coherent ? coherent_query : incoherent_query, packet);
    for (int i = 0; i < width; ++i) {
        if (!valid[i] || packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        const OccluderGeometry& geometry = set.geometries[packet.hit.geomID[i]];
        hits.t[base + i] = packet.ray.tfar[i];
        hits.instance[base + i] = geometry.instance;
        hits.triangle[base + i] = static_cast<int32_t>(geometry.triangle_in_mesh(packet.hit.primID[i]));
        hits.u[base + i] = packet.hit.u[i], hits.v[base + i] = packet.hit.v[i];
    }
}

// Which lanes to trace (-1): active, valid and of non-zero length. Invalid ones become blocked, empty ones free.
// Branch-free, so that the compiler vectorizes it.
template<int width> void choose_lanes(const Occluders::ShadowRays& rays, int base, int* valid, float* visibility) {
    const auto large = [](float value) { return !(std::abs(value) <= largest_coordinate); }; // or NaN
    for (int i = 0; i < width; ++i) {
        const int k = base + i;
        const int origin = large(rays.ox[k]) | large(rays.oy[k]) | large(rays.oz[k]);
        const int direction = large(rays.dx[k]) | large(rays.dy[k]) | large(rays.dz[k]);
        const int ends = large(rays.t_min[k]) | !(rays.t_min[k] >= 0) | (rays.t_max[k] != rays.t_max[k]);
        const int unfit = origin | direction | ends, asked = rays.active[k] != 0;
        const float answer = unfit ? 0.0f : 1.0f;
        visibility[k] = asked ? answer : visibility[k];
        valid[i] = -(asked & (unfit ^ 1) & (rays.t_max[k] > rays.t_min[k]));
    }
}

template<class Packet, int width>
void trace_transmission(const OccluderSet* const* sets, const Occluders::ShadowRays& rays, int base,
                        float* visibility) {
    alignas(64) int valid[width];
    choose_lanes<width>(rays, base, valid, visibility);
    Packet packet;
    constexpr size_t bytes = width * sizeof(float);
    std::memcpy(packet.org_x, rays.ox + base, bytes), std::memcpy(packet.org_y, rays.oy + base, bytes);
    std::memcpy(packet.org_z, rays.oz + base, bytes), std::memcpy(packet.dir_x, rays.dx + base, bytes);
    std::memcpy(packet.dir_y, rays.dy + base, bytes), std::memcpy(packet.dir_z, rays.dz + base, bytes);
    std::memcpy(packet.tnear, rays.t_min + base, bytes), std::memcpy(packet.tfar, rays.t_max + base, bytes);
    for (int i = 0; i < width; ++i) packet.time[i] = 0, packet.mask[i] = ~0u, packet.id[i] = i, packet.flags[i] = 0;

    ShadowContext context;
    for (int which = 0; which < 2; ++which) {
        if (!sets[which] || sets[which]->triangles == 0) continue;
        const OccluderSet& set = *sets[which];
        if (set.has_alpha) context.forget();
        occlude(set.scene, valid, context.embree, coherent_query, packet);
        for (int i = 0; i < width; ++i) {
            const int blocked = packet.tfar[i] < 0;
            visibility[base + i] = blocked & valid[i] ? 0.0f : visibility[base + i];
            valid[i] &= blocked - 1;
        }
        if (!set.has_alpha) continue;
        for (int i = 0; i < width; ++i)
            if (valid[i]) visibility[base + i] *= static_cast<float>(context.left[i]);
    }
}
}

void Occluders::closest(std::span<const Ray> rays, float t_min, Hits& hits, bool coherent) const {
    hits.t.fill(infinity), hits.instance.fill(-1), hits.triangle.fill(-1), hits.u.fill(0), hits.v.fill(0);
    for (const OccluderSet* set : {impl_->still.get(), impl_->moving.get()}) {
        if (set->triangles == 0) continue;
        if (traces_sixteen()) {
            trace_closest<RTCRayHit16, 16>(*set, rays, t_min, 0, coherent, hits);
        } else {
            trace_closest<RTCRayHit8, 8>(*set, rays, t_min, 0, coherent, hits);
            if (rays.size() > 8) trace_closest<RTCRayHit8, 8>(*set, rays, t_min, 8, coherent, hits);
        }
    }
}

namespace {
// Traces through two sets, either of which may be null.
void trace_packets(const OccluderSet* const* sets, const Occluders::ShadowRays& rays, float* visibility) {
    if (traces_sixteen()) {
        trace_transmission<RTCRay16, 16>(sets, rays, 0, visibility);
    } else {
        trace_transmission<RTCRay8, 8>(sets, rays, 0, visibility);
        trace_transmission<RTCRay8, 8>(sets, rays, 8, visibility);
    }
}
}

void Occluders::transmission(const ShadowRays& rays, float* visibility) const {
    const OccluderSet* sets[2] = {impl_->still.get(), impl_->moving.get()};
    trace_packets(sets, rays, visibility);
}

void Occluders::alpha_transmission(const ShadowRays& rays, float* visibility) const {
    const OccluderSet* sets[2] = {passing_part(*impl_->scene, *impl_->still),
                                  passing_part(*impl_->scene, *impl_->moving)};
    trace_packets(sets, rays, visibility);
}

float Occluders::transmission(const Ray& ray, float t_min) const {
    if (!in_range(ray.origin) || !in_range(ray.direction) || !in_range(t_min) || !(t_min >= 0)) return 0;
    if (!(ray.t_max > t_min)) return std::isnan(ray.t_max) ? 0.0f : 1.0f;
    ShadowContext context;
    float visibility = 1;
    for (const OccluderSet* set : {impl_->still.get(), impl_->moving.get()}) {
        if (set->triangles == 0) continue;
        if (set->has_alpha) context.forget();
        RTCRay single{ray.origin.x,
                      ray.origin.y,
                      ray.origin.z,
                      t_min,
                      ray.direction.x,
                      ray.direction.y,
                      ray.direction.z,
                      0,
                      ray.t_max,
                      ~0u,
                      0,
                      0};
        occlude(set->scene, context.embree, coherent_query, single);
        if (single.tfar < 0) return 0;
        if (set->has_alpha) visibility *= static_cast<float>(context.left[0]);
    }
    return visibility;
}
}
