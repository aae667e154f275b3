// Lit stretches and shells of a packet of rays, light by light.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/shadow_volume_kernel.cpp"
#include <hwy/foreach_target.h>

#include "modes/shadow_volume.h"
#include "modes/style.h"
#include "scene/cone.h"

#include "modes/shadow_volume_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// How far the angle seen from a local light may turn on one set of nodes: less where the phase function has a lobe.
double widest_turn(const ShadowVolumeFrame& frame) {
    float g = 0;
    for (const Medium& medium : frame.snapshot.media) g = std::max(g, std::abs(medium.optics.phase.g));
    return std::min(0.8, 4 * (1 - double(g)));
}

// Far along the ray the angle hardly turns while fog goes on: parts end at ±1, ±3, ±9 ... times the light's distance.
double next_bound(double x) {
    double bound = 1;
    while (bound <= std::abs(x)) bound *= 3;
    if (x >= -1) return bound;
    return -bound / (bound / 3 < -x ? 3 : 9);
}

// Nodes on a part of a ray in which nothing has a kink: in the angle seen from a local light, in which 1/r² is constant
// (Kulla & Fajardo 2012, section 4.1), else along the ray.
void push_part(Packet& packet, int light, size_t lane, size_t cut, double low, double high) {
    const ShadowVolumeFrame& frame = packet.frame;
    const LightAlong& along = packet.scratch.along[lane];
    if (light == no_light || !along.local()) {
        if (frame.sampled) return push_node(packet, light, lane, cut, 0.5 * (low + high), high - low);
        for (const QuadratureNode& node : frame.nodes)
            push_node(packet, light, lane, cut, 0.5 * (low + high) + 0.5 * (high - low) * node.at,
                      0.5 * (high - low) * node.weight);
        return;
    }
    const double scale = std::max<double>({along.distance, along.light->radius, smallest_radius});
    const auto place = [&](double t) { return (t - along.nearest) / scale; };
    const double end = place(high), widest = widest_turn(frame);
    for (double x = place(low); x < end;) {
        const double next = std::min(next_bound(x), end), from = std::atan(x), to = std::atan(next);
        const double turns = frame.sampled ? 1 : std::ceil((to - from) / widest), half = 0.5 * (to - from) / turns;
        for (double i = 0; i < turns; ++i)
            for (const QuadratureNode& node : frame.nodes) {
                const double at = std::tan(from + (2 * i + 1 + node.at) * half);
                push_node(packet, light, lane, cut, std::clamp(along.nearest + scale * at, low, high),
                          half * node.weight * scale * (1 + at * at));
            }
        x = next;
    }
}

// Whether a piece between cuts can be seen to hold fog.
bool counts(const Packet& packet, size_t lane, size_t cut) {
    if (!packet.frame.sampled) return true;
    constexpr float opaque = 16; // e^-16 = 1e-7
    const float from = packet.scratch.depth[cut][lane] * packet.frame.style.view_depth;
    return from < opaque && packet.scratch.depth[cut + 1][lane] > packet.scratch.depth[cut][lane];
}

// Cuts lit stretches at the cuts of the fog and at the kinks of the light.
void push_lit(Packet& packet, int light, size_t lane, std::span<const Stretch> lit, std::span<const Stretch> reached) {
    const std::vector<double>& at = packet.scratch.cuts[lane].at;
    size_t cut = 0, part = 0;
    for (const Stretch& stretch : lit) {
        double low = stretch.low;
        while (low < stretch.high) {
            while (cut + 1 < at.size() && at[cut + 1] <= low) ++cut;
            while (part < reached.size() && reached[part].high <= low) ++part;
            if (cut + 1 >= at.size() || part >= reached.size()) return;
            low = std::max({low, at[cut], reached[part].low});
            const double high = std::min({stretch.high, at[cut + 1], reached[part].high});
            if (high > low && counts(packet, lane, cut)) push_part(packet, light, lane, cut, low, high);
            low = std::max(low, high);
            if (low >= stretch.high) break;
        }
    }
}

// The mantle of a spot's beam, half way down its soft edge: crossings that change no count.
void append_mantle(const Light& light, const Ray& ray, std::vector<ShadowCrossing>& crossings) {
    if (light.kind != LightKind::spot) return;
    const dvec3 origin(ray.origin), direction(ray.direction), apex(light.position);
    const double angle = std::acos(0.5 * (std::cos(double(light.inner_cone)) + std::cos(double(light.outer_cone))));
    const Stretch beam = inside_cone(apex, glm::normalize(dvec3(light.direction)), angle, origin, direction);
    for (const double t : {beam.low, beam.high})
        if (!beam.empty() && std::isfinite(t)) crossings.push_back({t, glm::distance(origin + t * direction, apex), 0});
}

// A sheet of light wherever the ray goes through a side from light into shadow or back: as bright as some metres of the
// fog.
void push_shells(Packet& packet, int light, size_t lane, int dark, Stretch reached) {
    const ShadowVolumeSettings& settings = packet.frame.settings;
    const std::vector<double>& at = packet.scratch.cuts[lane].at;
    std::vector<ShadowCrossing>& crossings = packet.scratch.crossings[lane];
    append_mantle(*packet.scratch.along[lane].light, packet.batch.rays[lane], crossings);
    std::sort(crossings.begin(), crossings.end(),
              [](const ShadowCrossing& a, const ShadowCrossing& b) { return a.t < b.t; });
    size_t cut = 0;
    for (const ShadowCrossing& crossing : crossings) {
        const bool was_dark = dark > 0;
        dark += crossing.change;
        const bool edge = crossing.change ? (dark > 0) != was_dark : !was_dark;
        if (!edge || !(crossing.behind > 0) || crossing.t < reached.low || crossing.t > reached.high) continue;
        const double left = 1 - crossing.behind / settings.shell_length;
        if (left <= 0) continue;
        while (cut + 2 < at.size() && at[cut + 1] < crossing.t) ++cut;
        push_node(packet, light, lane, cut, crossing.t, settings.shell_intensity * settings.shell_length * left * left);
    }
}

// One light on all rays.
void add_light(Packet& packet, size_t index) {
    Scratch& scratch = packet.scratch;
    const ShadowVolumeFrame& frame = packet.frame;
    const Light& light = frame.snapshot.lights[index];
    const size_t count = packet.batch.rays.size();
    Stretch reached[16];
    int dark[16];
    for (size_t i = 0; i < count; ++i) {
        const std::vector<double>& at = scratch.cuts[i].at;
        const Ray& ray = packet.batch.rays[i];
        scratch.along[i].lit.clear();
        if (at.empty()) continue;
        find_light(light, center_of(light), {ray.origin, ray.direction, static_cast<float>(at.back())}, nullptr, {},
                   scratch.along[i]);
        const std::vector<Stretch>& lit = scratch.along[i].lit;
        if (!lit.empty()) reached[i] = {std::max(lit.front().low, at.front()), std::min(lit.back().high, at.back())};
    }
    find_shadows(frame, index, packet.batch, reached, scratch.crossings, dark);
    const int name = static_cast<int>(index);
    for (size_t i = 0; i < count; ++i) {
        if (reached[i].empty()) continue;
        if (frame.settings.draw == ShadowDraw::shells) {
            push_shells(packet, name, i, dark[i], reached[i]);
            continue;
        }
        scratch.lit.clear();
        append_lit(dark[i], scratch.crossings[i], reached[i], scratch.lit);
        push_lit(packet, name, i, scratch.lit, scratch.along[i].lit);
    }
    add_nodes(packet, name);
}

// Origins and directions; lanes without a ray repeat the last.
void load_rays(std::span<const Ray> rays, Vec3s& origin, Vec3s& direction) {
    alignas(64) float v[6][16];
    for (size_t i = 0; i < 16; ++i) {
        const Ray& ray = rays[std::min(i, rays.size() - 1)];
        for (int axis = 0; axis < 3; ++axis) v[axis][i] = ray.origin[axis], v[3 + axis][i] = ray.direction[axis];
    }
    origin = {load(v[0]), load(v[1]), load(v[2])}, direction = {load(v[3]), load(v[4]), load(v[5])};
}

// Optical depth of sampled fog at every cut, by the density in the middle of each step.
void sample_depths(Packet& packet) {
    Scratch& scratch = packet.scratch;
    const std::span<const Ray> rays = packet.batch.rays;
    size_t longest = 1;
    for (size_t i = 0; i < rays.size(); ++i) longest = std::max(longest, scratch.cuts[i].at.size());
    scratch.at.assign(longest, {}), scratch.depth.resize(longest);
    scratch.depth[0].fill(0);
    for (size_t i = 0; i < rays.size(); ++i) {
        const std::vector<double>& at = scratch.cuts[i].at;
        for (size_t k = 0; k < longest && !at.empty(); ++k)
            scratch.at[k][i] = static_cast<float>(at[std::min(k, at.size() - 1)]);
    }
    Vec3s origin, direction;
    load_rays(rays, origin, direction);
    Floats depth = 0.0f;
    for (size_t k = 0; k + 1 < longest; ++k) {
        const Floats from = load(scratch.at[k].data()), to = load(scratch.at[k + 1].data());
        const Vec3s point = fused(direction, (from + to) * 0.5f, origin);
        Floats extinction = 0.0f;
        for (const Medium& medium : packet.frame.snapshot.media)
            extinction = fused(density16(medium, point), medium.optics.extinction, extinction);
        depth = fused(extinction, to - from, depth);
        store(depth, scratch.depth[k + 1].data());
    }
}

// The optical depth of each whole ray.
void find_depths(Packet& packet, float (&depth)[16]) {
    const std::span<const Ray> rays = packet.batch.rays;
    const std::vector<std::array<float, 16>>& sampled = packet.scratch.depth;
    if (packet.frame.sampled) {
        std::copy(sampled.back().begin(), sampled.back().end(), depth);
        return;
    }
    alignas(64) float end[16] = {};
    for (size_t i = 0; i < rays.size(); ++i) {
        const std::vector<double>& at = packet.scratch.cuts[i].at;
        if (!at.empty()) end[i] = static_cast<float>(at.back());
    }
    Vec3s origin, direction;
    load_rays(rays, origin, direction);
    store(closed_depth(packet.frame, {origin, direction, load(end)}), depth);
}

// What emission and ambient light add for each share of light the fog takes away, where all media agree; -1 elsewhere.
vec3 even_glow(const ShadowVolumeFrame& frame) {
    vec3 common(0);
    for (const Medium& medium : frame.snapshot.media) {
        const vec3 own = glow_per_extinction(medium.optics, frame.snapshot.ambient);
        if (&medium != &frame.snapshot.media.front() && own != common) return vec3(-1);
        common = own;
    }
    return common;
}

void add_glow(Packet& packet, const float (&depth)[16]) {
    const ShadowVolumeFrame& frame = packet.frame;
    const vec3 even = even_glow(frame);
    if (even == vec3(0)) return;
    const size_t count = packet.batch.rays.size();
    if (even.x >= 0 && frame.style.view_depth > 0 && frame.style.range >= StyleSettings().range) {
        for (size_t i = 0; i < count; ++i)
            packet.radiance[i] -= even * (std::expm1(-frame.style.view_depth * depth[i]) / frame.style.view_depth);
        return;
    }
    for (size_t i = 0; i < count; ++i) {
        const std::vector<double>& at = packet.scratch.cuts[i].at;
        for (size_t k = 0; k + 1 < at.size(); ++k)
            if (counts(packet, i, k)) push_part(packet, no_light, i, k, at[k], at[k + 1]);
    }
    add_nodes(packet, no_light);
}

float validity_of(const ShadowVolumeFrame& frame, const Ray& ray) {
    if (frame.settings.draw == ShadowDraw::shells) return 0;
    for (const Box& box : frame.uneven)
        if (!clip(box, ray.origin, ray.direction, {0, ray.t_max}).empty()) return 0;
    return 1;
}

void shadow_volume_kernel(const ShadowVolumeFrame& frame, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local Scratch scratch;
    Packet packet{frame, batch, scratch, {}, {}};
    const size_t count = batch.rays.size(), lights = frame.snapshot.lights.size();
    for (size_t i = 0; i < count; ++i) find_cuts(frame, batch.rays[i], scratch.cuts[i]);
    if (frame.sampled) sample_depths(packet);
    alignas(64) float depth[16];
    find_depths(packet, depth);

    vec3 total[16];
    std::fill(packet.radiance, packet.radiance + 16, vec3(0));
    if (frame.settings.draw == ShadowDraw::exact) add_glow(packet, depth);
    std::copy(packet.radiance, packet.radiance + 16, total);
    for (size_t light = 0; light < lights; ++light) {
        std::fill(packet.radiance, packet.radiance + 16, vec3(0));
        add_light(packet, light);
        for (size_t i = 0; i < count; ++i) {
            total[i] += packet.radiance[i];
            if (!batch.per_light.empty()) batch.per_light[i * lights + light] += packet.radiance[i];
        }
    }
    for (size_t i = 0; i < count; ++i)
        results[i] = {total[i], std::exp(-depth[i]), validity_of(frame, batch.rays[i]), packet.asked[i]};
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(shadow_volume_kernel);
void shadow_volume_packet(const ShadowVolumeFrame& frame, const RayBatch& batch, std::span<Scatter> results) {
    HWY_DYNAMIC_DISPATCH(shadow_volume_kernel)(frame, batch, results);
}
}
#endif
