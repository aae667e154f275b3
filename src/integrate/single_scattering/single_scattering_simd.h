// The single-scattering integrand at sixteen points on any rays of a packet; part of the single-scattering kernel (see
// base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_INTEGRATE_SINGLE_SCATTERING_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_SINGLE_SCATTERING_SIMD_H
#undef TYNDALL_INTEGRATE_SINGLE_SCATTERING_SIMD_H
#else
#define TYNDALL_INTEGRATE_SINGLE_SCATTERING_SIMD_H
#endif

#include "integrate/equi_angular_simd.h"
#include "integrate/scattering_simd.h"
#include "integrate/shadow_rays_simd.h"
#include "integrate/single_scattering/single_scattering.h"
#include "integrate/style_simd.h"
#include "volume/medium_simd.h"

#include <array>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
constexpr int no_light = -1;       // emission and ambient light
constexpr int multiple_light = -2; // multiple scattering
constexpr int ambient_light = -3;  // the ambient part of no_light
constexpr int emission_light = -4; // the emission part

// A batch of sixteen quadrature nodes on any rays. With Spread::angle, intervals are relative to the point on the ray
// closest to the light.
struct Nodes {
    alignas(64) float low[16], high[16];
    alignas(64) float share[16];  // position of the node in its interval, 0..1
    alignas(64) float weight[16]; // quadrature weight
    alignas(64) int32_t ray[16];
    alignas(64) int32_t cut[16]; // last cut before the interval: cut·16 + ray
    int count = 0;
};

// Per-thread memory reused from packet to packet.
struct Scratch {
    RaySegments cuts;
    std::vector<float> depth;      // sampled fog: optical depth from the eye to each cut
    std::vector<float> extinction; // sampled fog: at each step's midpoint, [(step·media + medium)·16 + ray]
    std::vector<float> whole;      // share of a distant light that lights the whole step: [step·16 + ray]
    std::vector<std::array<float, 16>> phase; // phase function per medium and ray
    std::vector<ShadowCrossing> crossings;
    std::vector<Interval<double>> lit[16];
    LightAlong along[16]; // for local lights
    Nodes nodes;
};

// How nodes are distributed on an interval: by length; by the angle seen from a local light, which cancels 1/r² (Kulla
// & Fajardo 2012, section 4.1); or as single points with explicit weights.
enum class Spread { length, angle, points };

struct Packet {
    const SingleScattering& frame;
    const RayBatch& batch;
    Scratch& scratch;
    alignas(64) float origin[3][16], direction[3][16];
    QuadratureNode jittered[16]; // the single node per ray for sampled shadows
    Spread spread = Spread::length;
    double light_share = 1;  // share of the light that the current nodes represent
    bool full_steps = false; // mark fully lit steps in `whole`
    // t of the point closest to the light, and its distance; 0 unless `spread` is angle
    alignas(64) float nearest[16] = {}, away[16] = {};
    vec3 radiance[16] = {}; // from the current light
    int evals[16] = {};

    // Loads a vector per ray, or gathers it for the ray of each node.
    HWY_INLINE static Vec3s rays(const float (&v)[3][16]) { return {load(v[0]), load(v[1]), load(v[2])}; }
    HWY_INLINE static Vec3s rays(const float (&v)[3][16], const Ints& ray) {
        return {gather(v[0], ray), gather(v[1], ray), gather(v[2], ray)};
    }
};

// In-scattering from one light per meter at the queued nodes.
HWY_INLINE Vec3s scattered(const Packet& packet, size_t index, const Vec3s& position, const Vec3s& direction) {
    const SingleScattering& frame = packet.frame;
    const Light& light = frame.snapshot.lights[index];
    const LightSamples light_at = arrival16(light, frame.cones[index], position);
    const Nodes& nodes = packet.scratch.nodes;
    Floats amount = light_at.amount;
    if (frame.shadows[index].by == ShadowMethod::rays) {
        const auto key = [&](size_t lane) {
            const uint32_t id = packet.batch.ids[static_cast<size_t>(nodes.ray[lane])];
            return hash(id, static_cast<uint32_t>(nodes.cut[lane]), static_cast<uint32_t>(index));
        };
        const Mask16 wanted = (amount > 0.0f) & (load(nodes.weight) > 0.0f);
        amount = amount * traced_visibility(*shadow_casters(light, frame.snapshot), light, position, light_at, wanted,
                                            frame.light_points, key);
    }
    const std::vector<Medium>& media = frame.snapshot.media;
    const Vec3s towards = scattering(media, position, dot(light_at.to_light, direction), [&](size_t m) HWY_ATTR {
        return density16(media[m], position) * gray_extinction(media[m].optics);
    });
    return scattered_light(light, frame.depths[index], position, amount, towards);
}

// Emission and scattered ambient light per meter, or one of them.
HWY_INLINE Vec3s other_source(const SingleScattering& frame, int light, const Vec3s& position) {
    const vec3 ambient = light == emission_light ? vec3(0) : frame.snapshot.ambient;
    Vec3s sum = splat(vec3(0));
    for (const Medium& medium : frame.snapshot.media) {
        const Optics& optics = medium.optics;
        const vec3 emission = light == ambient_light ? vec3(0) : optics.emission.radiance;
        if (optics.albedo_field) {
            const Vec3s scattered = albedo16(optics, position) * splat(gray_extinction(optics) * ambient);
            sum = fma(scattered + splat(emission), density16(medium, position), sum);
            continue;
        }
        const vec3 per_density = gray_extinction(optics) * optics.albedo * ambient + emission;
        sum = fma(splat(per_density), density16(medium, position), sum);
    }
    return sum;
}

// In-scattering of multiply scattered light per meter.
HWY_INLINE Vec3s multiply_scattered(const SingleScattering& frame, const Vec3s& position, const Vec3s& direction) {
    const std::vector<Medium>& media = frame.snapshot.media;
    return scattered_fluence(*frame.fluence, media, position, direction, [&](size_t m) HWY_ATTR {
        return density16(media[m], position) * gray_extinction(media[m].optics);
    });
}

HWY_INLINE Floats closed_depth(const SingleScattering& frame, const Segments16& paths) {
    Floats depth = 0.0f;
    for (const Medium& medium : frame.snapshot.media) depth = depth + analytic_depth16(medium, paths);
    return depth;
}

// Positions of the queued nodes on their rays, and the lengths they represent.
struct Placed {
    Floats t, length;
};
HWY_INLINE Placed place_nodes(const Packet& packet, const Nodes& nodes, const Ints& ray) {
    const Floats low = load(nodes.low), high = load(nodes.high), share = load(nodes.share);
    const Floats weight = load(nodes.weight);
    if (packet.spread == Spread::points) return {low, weight};
    if (packet.spread == Spread::length) return {fma(share, high - low, low), weight * (high - low)};
    const EquiAngular16 turning({low, high}, gather(packet.away, ray));
    const Floats slope = turning.slope(share);
    return {fma(slope, turning.height, gather(packet.nearest, ray)), turning.length(weight, slope)};
}

// Optical depth from the eye to the nodes, linear between cuts of sampled fog.
HWY_INLINE Floats depth_at(const Packet& packet, const Nodes& nodes, const Segments16& to_nodes) {
    if (!packet.frame.sampled) return closed_depth(packet.frame, to_nodes);
    const float *at = packet.scratch.cuts.at.data(), *depth = packet.scratch.depth.data();
    const Ints cut = load(nodes.cut);
    const Floats before = gather(at, cut), depth_before = gather(depth, cut);
    const Floats share = (to_nodes.length - before) / max(gather(at + 16, cut) - before, 1e-12f);
    return fma(gather(depth + 16, cut) - depth_before, max(min(share, 1.0f), 0.0f), depth_before);
}

// Transmittance to the eye of the fog a point stands for: `depth` deep in the middle and `inside` deep by itself, with
// `beyond` added. Equal steps may be so deep that the middle does not stand for all; steps of a rule are not.
HWY_INLINE Floats seen_through(const SingleScattering& frame, const Floats& depth, const Floats& inside,
                               const Floats& beyond) {
    if (!frame.sampled || frame.rule) return exp(-(depth * frame.style.view_depth + beyond));
    const Floats before = max(depth - inside * 0.5f, 0.0f) * frame.style.view_depth;
    return exp(-(before + beyond)) * mean_transmittance(inside * frame.style.view_depth);
}

// Optical depth of the fog that the queued nodes stand for, in equal steps.
HWY_INLINE Floats depth_inside(const Packet& packet, const Nodes& nodes, const Floats& length) {
    if (!packet.frame.sampled || packet.frame.rule || packet.spread == Spread::points) return 0.0f;
    const float *at = packet.scratch.cuts.at.data(), *depth = packet.scratch.depth.data();
    const Ints cut = load(nodes.cut);
    const Floats step = gather(at + 16, cut) - gather(at, cut);
    return (gather(depth + 16, cut) - gather(depth, cut)) * (length / max(step, 1e-12f));
}

// Evaluates the queued nodes and adds them to their rays.
void add_nodes(Packet& packet, int light) {
    const SingleScattering& frame = packet.frame;
    Nodes& nodes = packet.scratch.nodes;
    if (nodes.count == 0) return;
    for (int i = nodes.count; i < 16; ++i) {
        nodes.low[i] = nodes.high[i] = nodes.low[0], nodes.share[i] = nodes.weight[i] = 0;
        nodes.ray[i] = nodes.ray[0], nodes.cut[i] = nodes.cut[0];
    }
    const Ints ray = load(nodes.ray);
    const Placed placed = place_nodes(packet, nodes, ray);
    const Vec3s origin = Packet::rays(packet.origin, ray), direction = Packet::rays(packet.direction, ray);
    const Vec3s position = fma(direction, placed.t, origin);
    const Floats depth = depth_at(packet, nodes, {origin, direction, placed.t});
    Floats weight = placed.length * seen_through(frame, depth, depth_inside(packet, nodes, placed.length), 0.0f);
    if (frame.style.range < StyleSettings().range) weight = weight * style_fade(frame.style, frame.camera, position);
    const Vec3s source = light >= 0                ? scattered(packet, static_cast<size_t>(light), position, direction)
                         : light == multiple_light ? multiply_scattered(frame, position, direction)
                                                   : other_source(frame, light, position);
    alignas(64) float r[16], g[16], b[16];
    store(source.x * weight, r), store(source.y * weight, g), store(source.z * weight, b);
    const int work = 1 + (light >= 0 ? march_work(frame.depths[static_cast<size_t>(light)]) : 0);
    for (int i = 0; i < nodes.count; ++i) {
        packet.radiance[nodes.ray[i]] += vec3(r[i], g[i], b[i]);
        packet.evals[nodes.ray[i]] += work;
    }
    nodes.count = 0;
}

// Queues a node on low..high after cut `cut`; evaluates the queue when it is full.
HWY_INLINE void push_node(Packet& packet, int light, size_t ray, int cut, double low, double high, double share,
                          double weight) {
    Nodes& nodes = packet.scratch.nodes;
    const int i = nodes.count++;
    nodes.low[i] = static_cast<float>(low), nodes.high[i] = static_cast<float>(high);
    nodes.share[i] = static_cast<float>(share), nodes.weight[i] = static_cast<float>(weight * packet.light_share);
    nodes.ray[i] = static_cast<int32_t>(ray), nodes.cut[i] = 16 * cut + static_cast<int32_t>(ray);
    if (nodes.count == 16) add_nodes(packet, light);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
