#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/cone/kernel.cpp"
#include <hwy/foreach_target.h>

#include "modes/cone/cone.h"

#include "integrate/batch_simd.h"
#include "modes/cone/local_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// A sun (light not null), or emission and ambient light: integrands without a 1/r² peak, integrated in t.
struct EvenLight {
    const Packet& packet;
    const ConeLight* light;
    Floats cosine;

    HWY_INLINE Floats depth_at(const Floats& t) const {
        const Floats depth = view_depth(packet, t) * packet.cone.style.view_depth;
        return light ? depth + light_depth(packet, *light, packet.at(t), 0.0f) : depth;
    }
};

// Whether optical depths are linear between the breaks.
bool is_linear(const Packet& packet) {
    const auto homogeneous = [](const Medium& medium) { return medium.density.kind == DensityKind::homogeneous; };
    return std::ranges::all_of(packet.fog.media, homogeneous) && packet.cone.style.range >= no_range;
}

// ∫ e^-τ dt in closed form. τ is evaluated at two points inside the segment: at its ends, rounding would decide on
// which side of a face they lie.
void add_linear_piece(const EvenLight& even, const Interval<Floats>& piece) {
    const Floats length = piece.high - piece.low;
    const Floats early = even.depth_at(fma(length, 0.25f, piece.low));
    const Floats late = even.depth_at(fma(length, 0.75f, piece.low));
    const Floats half = abs(late - early), least = min(early, late) - 0.5f * half;
    add_node(even.packet, fma(length, 0.5f, piece.low), length * exp(-least) * mean_transmittance(2.0f * half),
             even.cosine, even.light);
}

void add_curved_piece(const EvenLight& even, const Interval<Floats>& piece) {
    const Floats length = piece.high - piece.low, first = even.depth_at(piece.low), last = even.depth_at(piece.high);
    const Mask16 bright = (length > 0.0f) & (min(first, last) < 60.0f);
    if (!any(bright)) return;
    const int count = node_count(even.packet, 0, zero_unless(bright, abs(last - first)), zero_unless(bright, length));
    for (const QuadratureNode& node : gauss_legendre(count)) {
        const Floats t = fma(length, static_cast<float>(node.at), piece.low);
        const Floats weight = length * static_cast<float>(node.weight) * fade(even.packet, t);
        add_node(even.packet, t, weight * exp(-even.depth_at(t)), even.cosine, even.light);
    }
}

bool add_even(Packet& packet, const ConeLight* light) {
    find_fog(packet);
    Interval<Floats> stretch = packet.stretch;
    if (packet.cone.style.range < no_range) stretch.high = min(stretch.high, packet.cone.style.range - packet.before);
    const Mask16 lit = stretch.high > stretch.low;
    if (!any(lit)) return false;
    stretch = {zero_unless(lit, stretch.low), zero_unless(lit, stretch.high)};
    packet.scratch.breaks.clear();
    add_fog_breaks(packet, 0.0f);
    sort_breaks(packet, stretch);

    const EvenLight even{packet, light, light ? -dot(packet.direction, splat(light->light.direction)) : Floats(0.0f)};
    const bool linear = is_linear(packet);
    const std::vector<Lanes>& breaks = packet.scratch.breaks;
    for (size_t i = 0; i + 1 < breaks.size(); ++i) {
        const Interval<Floats> piece{load(breaks[i].data()), load(breaks[i + 1].data())};
        if (!any(piece.high > piece.low)) continue;
        linear ? add_linear_piece(even, piece) : add_curved_piece(even, piece);
    }
    return true;
}

// Sum over media of scratch.sums times `color`.
template<class Color> Vec3s light_of_sums(const Packet& packet, const Color& color) {
    Vec3s light = splat(vec3(0));
    for (size_t m = 0; m < packet.media(); ++m)
        light = fma(splat(color(m)), load(packet.scratch.sums[m].data()), light);
    return light;
}

void clear_sums(const Packet& packet) {
    for (size_t m = 0; m < packet.media(); ++m) packet.scratch.sums[m].fill(0);
}

float brightest(const std::vector<vec3>& colors) {
    float result = 0;
    for (const vec3 color : colors) result = std::max(result, max_component(color));
    return result;
}

// Emission and ambient light. For a single medium ∫ σ e^-τ dt = 1 - e^-τ, whatever its density.
Vec3s other_light(Packet& packet, const Floats& depth, const RayBatch& batch) {
    const Cone& cone = packet.cone;
    if (!(brightest(cone.ambient) > 0) && !(brightest(cone.emission) > 0)) return splat(vec3(0));
    if (packet.media() == 1 && cone.style.range >= no_range)
        store(depth * mean_transmittance(depth * cone.style.view_depth), packet.scratch.sums[0].data());
    else
        add_even(packet, nullptr);
    if (!batch.parts.empty()) {
        add_part(light_of_sums(packet, [&](size_t m) { return cone.ambient[m]; }), batch.index_of(OtherLight::ambient),
                 batch);
        add_part(light_of_sums(packet, [&](size_t m) { return cone.emission[m]; }),
                 batch.index_of(OtherLight::emission), batch);
    }
    const Vec3s light = light_of_sums(packet, [&](size_t m) { return cone.ambient[m] + cone.emission[m]; });
    clear_sums(packet);
    return light;
}

// Single scattering of one light; false if it contributes nothing. Color channels of a gobo are integrated one by one.
bool add_light(Packet& packet, const ConeLight& light, Vec3s& added) {
    const vec3 intensity = light.light.intensity * light.light.volume_scale;
    const bool colors = light.light.filter && has_colors(*light.light.filter);
    bool some = false;
    for (int channel = 0; channel < (colors ? 3 : 1); ++channel) {
        packet.channel = channel;
        if (!(is_distant(light.light) ? add_even(packet, &light) : add_local(packet, light))) continue;
        vec3 seen = intensity;
        if (colors) seen = vec3(0), seen[channel] = intensity[channel];
        const Vec3s light_of_channel =
            light_of_sums(packet, [&](size_t m) { return packet.fog.media[m].optics.albedo * seen; });
        added = some ? added + light_of_channel : light_of_channel;
        clear_sums(packet);
        some = true;
    }
    return some;
}

// Halved for each approximation: grids at their mean density, light without its shadows.
float validity_of(const Cone& cone, const Ray& ray, bool unshadowed) {
    float validity = unshadowed ? 0.5f : 1.0f;
    for (const Box& grid : cone.grids)
        if (!clip(grid, ray.origin, ray.direction, {0, ray.t_max}).empty()) return validity * 0.5f;
    return validity;
}

void cone_packet_kernel(const Cone& cone, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local Scratch scratch;
    const size_t media = cone.fog.media.size();
    scratch.from.resize(media), scratch.to.resize(media), scratch.sums.assign(media, Lanes{});
    Packet eye = make_packet(cone, cone.fog, batch, scratch);
    find_fog(eye);
    const Floats depth = view_depth(eye, eye.t_max);
    Vec3s radiance = other_light(eye, depth, batch);
    Floats unshadowed = 0.0f;
    for (size_t l = 0; media > 0 && l < cone.lights.size(); ++l) {
        const ConeLight& light = cone.lights[l];
        Packet packet = make_packet(cone, light.fog, batch, scratch);
        Vec3s added = splat(vec3(0));
        if (!add_light(packet, light, added)) continue;
        radiance = radiance + added;
        if (cone.casts && light.light.shadows) unshadowed = unshadowed + added.x + added.y + added.z;
        add_part(added, l, batch);
    }

    alignas(64) float rgbt[5][16];
    store(radiance.x, rgbt[0]), store(radiance.y, rgbt[1]), store(radiance.z, rgbt[2]);
    store(exp(-depth), rgbt[3]), store(unshadowed, rgbt[4]);
    for (size_t lane = 0; lane < batch.rays.size(); ++lane) {
        results[lane] = {};
        results[lane].radiance = vec3(rgbt[0][lane], rgbt[1][lane], rgbt[2][lane]);
        results[lane].transmittance = rgbt[3][lane];
        results[lane].validity = validity_of(cone, batch.rays[lane], rgbt[4][lane] > 0);
    }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(cone_packet_kernel);
void cone_packet(const Cone& cone, const RayBatch& batch, std::span<Scatter> results) {
    HWY_DYNAMIC_DISPATCH(cone_packet_kernel)(cone, batch, results);
}
}
#endif
