// Embree filter callbacks: whether a ray passes the hole of an alpha mask or a blended surface.
#include "trace/occlusion/scene.h"

#include <cstring>

namespace tyndall {
namespace {
constexpr double dark = 1e-6; // less light than this counts as blocked

// Whether a hit was counted before: two triangles that share an edge both report a ray that hits it, at the same
// distance up to rounding.
bool passed_before(ShadowContext& context, int lane, uint32_t geometry, float t, float reach) {
    const int known = std::min(context.count[lane], ShadowContext::remembered);
    for (int i = 0; i < known; ++i) {
        const ShadowContext::Passed& passed = context.passed[lane][i];
        if (passed.geometry == geometry && std::abs(passed.t - t) <= 1e-6f * reach) return true;
    }
    context.passed[lane][context.count[lane]++ % ShadowContext::remembered] = {geometry, t};
    return false;
}
}

void ShadowContext::forget() {
    for (int lane = 0; lane < 16; ++lane) left[lane] = 1, count[lane] = 0;
}

float OccluderGeometry::opacity(uint32_t triangle, float u, float v) const {
    if (!masks() && !blends()) return 1;
    float alpha = material->alpha;
    const glm::uvec3 corners = mesh->triangles[triangle];
    if (!mesh->alphas.empty()) alpha *= interpolated(mesh->alphas, corners, u, v);
    if (base_texture && !mesh->uvs.empty())
        alpha *= sample_alpha(*base_texture, interpolated(mesh->uvs, corners, u, v));
    return opacity_at(*material, alpha);
}

void pass_mask_holes(const RTCFilterFunctionNArguments* call) {
    const auto& geometry = *static_cast<const OccluderGeometry*>(call->geometryUserPtr);
    for (unsigned i = 0; i < call->N; ++i) {
        if (!call->valid[i]) continue;
        const uint32_t triangle = geometry.triangle_in_mesh(RTCHitN_primID(call->hit, call->N, i));
        const float u = RTCHitN_u(call->hit, call->N, i), v = RTCHitN_v(call->hit, call->N, i);
        if (geometry.opacity(triangle, u, v) == 0) call->valid[i] = 0;
    }
}

void pass_light(const RTCFilterFunctionNArguments* call) {
    const auto& geometry = *static_cast<const OccluderGeometry*>(call->geometryUserPtr);
    // The context is the first member of what was passed to Embree.
    auto& context = *reinterpret_cast<ShadowContext*>(call->context);
    for (unsigned i = 0; i < call->N; ++i) {
        if (!call->valid[i]) continue;
        const uint32_t triangle = geometry.triangle_in_mesh(RTCHitN_primID(call->hit, call->N, i));
        const float u = RTCHitN_u(call->hit, call->N, i), v = RTCHitN_v(call->hit, call->N, i);
        const float opacity = geometry.opacity(triangle, u, v);
        if (opacity == 1) continue;
        call->valid[i] = 0;
        if (opacity == 0) continue;

        const int lane = static_cast<int>(RTCRayN_id(call->ray, call->N, i));
        const float t = RTCRayN_tfar(call->ray, call->N, i);
        const vec3 origin(RTCRayN_org_x(call->ray, call->N, i), RTCRayN_org_y(call->ray, call->N, i),
                          RTCRayN_org_z(call->ray, call->N, i));
        const float reach = t + max_component(glm::abs(origin));
        if (passed_before(context, lane, static_cast<uint32_t>(geometry.instance), t, reach)) continue;
        context.left[lane] *= 1.0 - opacity;
        if (context.left[lane] < dark) call->valid[i] = -1;
    }
}
}
