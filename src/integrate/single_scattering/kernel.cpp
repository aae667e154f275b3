// Single scattering with exact shadows along a packet of rays, light by light.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrate/single_scattering/kernel.cpp"
#include <hwy/foreach_target.h>

#include "integrate/lights/light_along.h"
#include "integrate/single_scattering/single_scattering.h"
#include "integrate/style.h"

#include "integrate/single_scattering/fluence_simd.h"
#include "integrate/single_scattering/full_steps_simd.h"
#include "integrate/single_scattering/quadrature_simd.h"
#include "integrate/single_scattering/shells_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Unused lanes repeat the last ray.
Packet make_packet(const SingleScattering& frame, const RayBatch& batch, Scratch& scratch) {
    Packet packet{frame, batch, scratch, {}, {}, {}};
    for (size_t i = 0; i < 16; ++i) {
        const Ray& ray = batch.rays[std::min(i, batch.rays.size() - 1)];
        packet.jittered[i] = {i < batch.jitter.size() ? batch.jitter[i] : 0.5f, 1};
        for (int axis = 0; axis < 3; ++axis)
            packet.origin[axis][i] = ray.origin[axis], packet.direction[axis][i] = ray.direction[axis];
    }
    return packet;
}

// The interval of a ray's fog that a light reaches. For local lights, along.lit holds its subintervals.
Interval<double> reach_of(Packet& packet, const Light& light, size_t i) {
    const RaySegments& cuts = packet.scratch.cuts;
    if (cuts.pieces[i] == 0) return {};
    if (is_distant(light)) return {cuts.low(i), cuts.high(i)};
    const Ray& ray = packet.batch.rays[i];
    LightAlong& along = packet.scratch.along[i];
    find_light(light, center_of(light), {ray.origin, ray.direction, cuts.high(i)}, nullptr, {}, along);
    const std::vector<Interval<double>>& lit = along.lit;
    if (lit.empty()) return {};
    packet.nearest[i] = static_cast<float>(along.nearest);
    packet.away[i] = static_cast<float>(along.height());
    return {std::max<double>(lit.front().low, cuts.low(i)), std::min<double>(lit.back().high, cuts.high(i))};
}

// Pushes nodes on the lit intervals within reach.
void push_all(Packet& packet, size_t index, const Interval<double> (&reached)[16]) {
    Scratch& scratch = packet.scratch;
    const bool sun = is_distant(packet.frame.snapshot.lights[index]);
    for (size_t i = 0; i < packet.batch.rays.size(); ++i) {
        if (reached[i].empty()) continue;
        const std::span<const Interval<double>> parts =
            sun ? std::span(&reached[i], 1) : std::span(scratch.along[i].lit);
        push_lit(packet, static_cast<int>(index), i, scratch.lit[i], parts);
    }
}

// Shadows by slices: every ray uses one or more sample points on the light, each with its own shadows.
void add_sliced(Packet& packet, size_t index, const Interval<double> (&reached)[16]) {
    const SingleScattering& frame = packet.frame;
    const Light& light = frame.snapshot.lights[index];
    const size_t count = packet.batch.rays.size();
    if (std::all_of(reached, reached + count, [](Interval<double> stretch) { return stretch.empty(); })) return;
    const uint32_t points = is_soft(light) ? static_cast<uint32_t>(frame.light_points) : 1;
    Ray rays[16];
    LightPoint picked[16];
    packet.light_share = 1.0 / points;
    for (uint32_t k = 0; k < points; ++k) {
        for (size_t i = 0; i < count; ++i) {
            rays[i] = packet.batch.rays[i];
            rays[i].t_max = reached[i].empty() ? 0 : static_cast<float>(reached[i].high);
            picked[i] = light_point(packet.batch, i, light, index, k, points);
        }
        find_lit(coherent_slices(*frame.shadows[index].slices, {rays, count}, {picked, count}), {rays, count},
                 {picked, count}, packet.scratch.lit);
        push_all(packet, index, reached);
    }
    packet.light_share = 1;
}

// Shadows, if any, are cast from the light's center.
void add_cut_out(Packet& packet, size_t index, const Interval<double> (&reached)[16]) {
    Scratch& scratch = packet.scratch;
    int dark[16];
    find_shadows(packet.frame, index, packet.batch, reached, scratch.crossings, dark);
    if (packet.frame.shells) {
        packet.spread = Spread::points;
        for (size_t i = 0; i < packet.batch.rays.size(); ++i)
            if (!reached[i].empty()) push_shells(packet, static_cast<int>(index), i, dark[i], reached[i]);
        return;
    }
    for (std::vector<Interval<double>>& lit : scratch.lit) lit.clear();
    append_lit(dark, scratch.crossings, reached, scratch.lit);
    push_all(packet, index, reached);
}

void add_light(Packet& packet, size_t index) {
    Scratch& scratch = packet.scratch;
    const SingleScattering& frame = packet.frame;
    const Light& light = frame.snapshot.lights[index];
    const size_t count = packet.batch.rays.size();
    Interval<double> reached[16];
    for (size_t i = 0; i < count; ++i) reached[i] = reach_of(packet, light, i);
    packet.spread = is_distant(light) ? Spread::length : Spread::angle;
    const ShadowMethod by = frame.shadows[index].by;
    packet.full_steps = frame.sampled && is_distant(light) && by != ShadowMethod::rays && !frame.shells;
    if (packet.full_steps) scratch.whole.assign(16 * static_cast<size_t>(scratch.cuts.max_pieces), 0.0f);
    if (by == ShadowMethod::slices)
        add_sliced(packet, index, reached);
    else
        add_cut_out(packet, index, reached);
    add_nodes(packet, static_cast<int>(index));
    if (packet.full_steps) add_full_steps(packet, index);
}

// Optical depth of sampled fog at every cut, from the density at the midpoint of each step.
void sample_depths(Packet& packet) {
    Scratch& scratch = packet.scratch;
    const size_t steps = static_cast<size_t>(scratch.cuts.max_pieces);
    const std::vector<Medium>& media = packet.frame.snapshot.media;
    scratch.depth.resize(16 * (steps + 1)), scratch.extinction.resize(16 * steps * media.size());
    const Vec3s origin = Packet::rays(packet.origin), direction = Packet::rays(packet.direction);
    Floats depth = 0.0f, from = load(scratch.cuts.at.data());
    store(depth, scratch.depth.data());
    for (size_t k = 1; k <= steps; ++k) {
        const Floats to = load(scratch.cuts.at.data() + 16 * k);
        const Vec3s point = fma(direction, (from + to) * 0.5f, origin);
        Floats extinction = 0.0f;
        for (size_t m = 0; m < media.size(); ++m) {
            const Floats own = density16(media[m], point) * gray_extinction(media[m].optics);
            store(own, scratch.extinction.data() + 16 * ((k - 1) * media.size() + m));
            extinction = extinction + own;
        }
        depth = fma(extinction, to - from, depth), from = to;
        store(depth, scratch.depth.data() + 16 * k);
    }
}

// The total optical depth of each ray.
Floats find_depths(const Packet& packet) {
    const RaySegments& cuts = packet.scratch.cuts;
    if (packet.frame.sampled) return load(packet.scratch.depth.data() + 16 * static_cast<size_t>(cuts.max_pieces));
    const float* end = cuts.at.data() + 16 * static_cast<size_t>(cuts.max_pieces);
    return closed_depth(packet.frame, {Packet::rays(packet.origin), Packet::rays(packet.direction), load(end)});
}

// The source function of emission and ambient light if it is the same for all media; else -1.
vec3 even_glow(const SingleScattering& frame, int light) {
    vec3 common(0);
    for (const Medium& medium : frame.snapshot.media) {
        const vec3 ambient = light == emission_light ? vec3(0) : frame.snapshot.ambient;
        const vec3 own =
            light == ambient_light ? medium.optics.albedo * ambient : source_radiance(medium.optics, ambient);
        if (medium.optics.albedo_field && own != vec3(0)) return vec3(-1);
        if (&medium != &frame.snapshot.media.front() && own != common) return vec3(-1);
        common = own;
    }
    return common;
}

void add_other_light(Packet& packet, int light, const Floats& depth) {
    const SingleScattering& frame = packet.frame;
    const vec3 even = even_glow(frame, light);
    if (even == vec3(0)) return;
    const size_t count = packet.batch.rays.size();
    if (even.x >= 0 && frame.style.range >= StyleSettings().range) {
        alignas(64) float taken[16]; // ∫ transmittance with style.view_depth over the optical depth
        store(depth * mean_transmittance(depth * frame.style.view_depth), taken);
        for (size_t i = 0; i < count; ++i) packet.radiance[i] += even * taken[i];
        return;
    }
    packet.spread = Spread::length;
    const RaySegments& cuts = packet.scratch.cuts;
    for (size_t i = 0; i < count; ++i)
        for (int k = 0; k < cuts.pieces[i]; ++k) {
            const float* at = cuts.at.data() + 16 * static_cast<size_t>(k) + i;
            if (has_visible_fog(packet, i, k)) push_piece(packet, {light, i, k, at[0], at[16]});
        }
    add_nodes(packet, light);
}

float validity_of(const SingleScattering& frame, const Ray& ray) {
    if (frame.shells) return 0;
    for (const Box& box : frame.heterogeneous)
        if (!clip(box, ray.origin, ray.direction, {0, ray.t_max}).empty()) return 0;
    return 1;
}

void single_scattering_kernel(const SingleScattering& frame, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local Scratch scratch;
    Packet packet = make_packet(frame, batch, scratch);
    const size_t count = batch.rays.size(), lights = frame.snapshot.lights.size();
    find_segments(frame, batch.rays, scratch.cuts);
    if (frame.sampled) sample_depths(packet);
    const Floats depth = find_depths(packet);
    alignas(64) float transmittance[16];
    store(exp(-depth), transmittance);

    vec3 total[16] = {};
    const auto take_part = [&](size_t part) {
        for (size_t i = 0; i < count; ++i) {
            total[i] += packet.radiance[i];
            if (!batch.parts.empty()) batch.part(i, part) += packet.radiance[i];
        }
        std::fill(packet.radiance, packet.radiance + 16, vec3(0));
    };
    if (batch.parts.empty()) {
        add_other_light(packet, no_light, depth);
        add_fluence(packet);
        take_part(0);
    } else {
        add_other_light(packet, ambient_light, depth), take_part(batch.index_of(OtherLight::ambient));
        add_other_light(packet, emission_light, depth), take_part(batch.index_of(OtherLight::emission));
        add_fluence(packet), take_part(batch.index_of(OtherLight::multiple));
    }
    for (size_t light = 0; light < lights; ++light) add_light(packet, light), take_part(light);
    for (size_t i = 0; i < count; ++i)
        results[i] = {total[i], transmittance[i], validity_of(frame, batch.rays[i]), packet.evals[i]};
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(single_scattering_kernel);
void single_scattering_packet(const SingleScattering& frame, const RayBatch& batch, std::span<Scatter> results) {
    HWY_DYNAMIC_DISPATCH(single_scattering_kernel)(frame, batch, results);
}
}
#endif
