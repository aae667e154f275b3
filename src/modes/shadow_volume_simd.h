// The integrand of shadow-volume at sixteen points of any rays, inside its kernel (see base/simd.h for how such files
// are compiled).
#if defined(TYNDALL_MODES_SHADOW_VOLUME_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_SHADOW_VOLUME_SIMD_H
#undef TYNDALL_MODES_SHADOW_VOLUME_SIMD_H
#else
#define TYNDALL_MODES_SHADOW_VOLUME_SIMD_H
#endif

#include "base/simd.h"
#include "modes/shadow_volume.h"
#include "trace/light_depth_simd.h"
#include "trace/light_simd.h"
#include "volume/medium_simd.h"
#include "volume/phase_simd.h"

#include <array>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
constexpr int no_light = -1;

// Points at which the integrand is asked for, sixteen at once, whichever rays they are on.
struct Nodes {
    alignas(64) float t[16], weight[16], depth[16]; // optical depth from the ray's origin; of sampled fog only
    alignas(64) float origin[3][16], direction[3][16];
    int lane[16];
    int count = 0;
};

// Memory that a thread keeps from packet to packet.
struct Scratch {
    FogCuts cuts[16];
    std::vector<std::array<float, 16>> at, depth; // the cuts of all rays, and the optical depth there: of sampled fog
    std::vector<ShadowCrossing> crossings[16];
    std::vector<Stretch> lit;
    LightAlong along[16];
    Nodes nodes;
};

struct Packet {
    const ShadowVolumeFrame& frame;
    const RayBatch& batch;
    Scratch& scratch;
    vec3 radiance[16]; // of the current light
    int asked[16] = {};
};

// Light of one light scattered towards the eye per metre.
HWY_INLINE Vec3s scattered(const ShadowVolumeFrame& frame, size_t index, const Vec3s& position,
                           const Vec3s& direction) {
    const Light& light = frame.snapshot.lights[index];
    const Arriving light_at = arriving(light, frame.cones[index], position);
    const Vec3s color = splat(light.intensity * light.volume_scale);
    const Floats cosine = dot(light_at.to_light, direction);
    Vec3s scattering = splat(vec3(0));
    for (const Medium& medium : frame.snapshot.media) {
        const Floats extinction = density16(medium, position) * medium.optics.extinction;
        scattering =
            fused(splat(medium.optics.albedo), extinction * phase_value(medium.optics.phase, cosine), scattering);
    }
    const Floats dimmed = exp(-light_depth16(frame.depths[index], position, light_at.amount > 0.0f));
    return scattering * (light_at.amount * dimmed) * color;
}

// Emission and ambient light per metre.
HWY_INLINE Vec3s glow(const ShadowVolumeFrame& frame, const Vec3s& position) {
    Vec3s sum = splat(vec3(0));
    for (const Medium& medium : frame.snapshot.media) {
        const Optics& optics = medium.optics;
        const vec3 per_density = optics.extinction * optics.albedo * frame.snapshot.ambient + optics.emission;
        sum = fused(splat(per_density), density16(medium, position), sum);
    }
    return sum;
}

HWY_INLINE Floats closed_depth(const ShadowVolumeFrame& frame, const LightPaths& paths) {
    Floats depth = 0.0f;
    for (const Medium& medium : frame.snapshot.media) depth = depth + analytic_depth16(medium, paths);
    return depth;
}

// Adds the waiting nodes to their rays.
void add_nodes(Packet& packet, int light) {
    const ShadowVolumeFrame& frame = packet.frame;
    Nodes& nodes = packet.scratch.nodes;
    if (nodes.count == 0) return;
    for (int i = nodes.count; i < 16; ++i) {
        nodes.t[i] = nodes.weight[i] = nodes.depth[i] = 0;
        for (int axis = 0; axis < 3; ++axis)
            nodes.origin[axis][i] = nodes.origin[axis][0], nodes.direction[axis][i] = nodes.direction[axis][0];
    }
    const Vec3s origin{load(nodes.origin[0]), load(nodes.origin[1]), load(nodes.origin[2])};
    const Vec3s direction{load(nodes.direction[0]), load(nodes.direction[1]), load(nodes.direction[2])};
    const Floats t = load(nodes.t);
    const Vec3s position = fused(direction, t, origin);
    const Floats depth = frame.sampled ? load(nodes.depth) : closed_depth(frame, {origin, direction, t});
    Floats weight = load(nodes.weight) * exp(-depth * frame.style.view_depth);
    if (frame.style.range < StyleSettings().range) {
        const Vec3s away = position - splat(frame.camera.position);
        const Floats share = (frame.style.range - sqrt(dot(away, away))) * (5 / frame.style.range);
        weight = weight * max(min(share, 1.0f), 0.0f);
    }
    const Vec3s source =
        light == no_light ? glow(frame, position) : scattered(frame, static_cast<size_t>(light), position, direction);
    alignas(64) float r[16], g[16], b[16];
    store(source.x * weight, r), store(source.y * weight, g), store(source.z * weight, b);
    for (int i = 0; i < nodes.count; ++i) {
        packet.radiance[nodes.lane[i]] += vec3(r[i], g[i], b[i]);
        ++packet.asked[nodes.lane[i]];
    }
    nodes.count = 0;
}

// `cut`: the piece between cuts in which t lies.
void push_node(Packet& packet, int light, size_t lane, size_t cut, double t, double weight) {
    Nodes& nodes = packet.scratch.nodes;
    const Ray& ray = packet.batch.rays[lane];
    const int i = nodes.count++;
    nodes.t[i] = static_cast<float>(t), nodes.weight[i] = static_cast<float>(weight);
    nodes.lane[i] = static_cast<int>(lane), nodes.depth[i] = 0;
    if (packet.frame.sampled) {
        const std::vector<double>& at = packet.scratch.cuts[lane].at;
        const float share = static_cast<float>((t - at[cut]) / (at[cut + 1] - at[cut]));
        const float from = packet.scratch.depth[cut][lane], to = packet.scratch.depth[cut + 1][lane];
        nodes.depth[i] = from + share * (to - from);
    }
    for (int axis = 0; axis < 3; ++axis)
        nodes.origin[axis][i] = ray.origin[axis], nodes.direction[axis][i] = ray.direction[axis];
    if (nodes.count == 16) add_nodes(packet, light);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
