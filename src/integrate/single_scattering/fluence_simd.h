// Multiple scattering from the fluence grid, part of the single-scattering kernel (see base/simd/simd.h for how such
// files are compiled).
#if defined(TYNDALL_INTEGRATE_SINGLE_SCATTERING_FLUENCE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_SINGLE_SCATTERING_FLUENCE_SIMD_H
#undef TYNDALL_INTEGRATE_SINGLE_SCATTERING_FLUENCE_SIMD_H
#else
#define TYNDALL_INTEGRATE_SINGLE_SCATTERING_FLUENCE_SIMD_H
#endif

#include "integrate/single_scattering/single_scattering_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
constexpr double deepest_part = 0.5; // maximum optical depth per part
constexpr double max_parts = 4096;   // per piece

// Extinction of all fog, scaled by the style's view_depth.
double extinction_at(const SingleScattering& frame, vec3 point) {
    double extinction = 0;
    for (const Medium& medium : frame.snapshot.media)
        extinction += double(gray_extinction(medium.optics)) * density_at(medium, point);
    return extinction * frame.style.view_depth;
}

// For sampled fog: evaluates the middle of every step, where the extinction is already known.
void add_fluence_steps(Packet& packet) {
    const SingleScattering& frame = packet.frame;
    const std::vector<Medium>& media = frame.snapshot.media;
    const Vec3s origin = Packet::rays(packet.origin), direction = Packet::rays(packet.direction);
    const float* at = packet.scratch.cuts.at.data();
    const float* depths = packet.scratch.depth.data();
    Vec3s radiance = splat(vec3(0));
    Floats evals = 0.0f;
    for (size_t k = 0; k < static_cast<size_t>(packet.scratch.cuts.max_pieces); ++k) {
        const Floats low = load(at + 16 * k), high = load(at + 16 * (k + 1));
        const Floats before = load(depths + 16 * k), depth = load(depths + 16 * (k + 1)) - before;
        const Mask16 wanted = (depth > 0.0f) & (before * frame.style.view_depth < frame.opaque);
        if (!any(wanted)) continue;
        evals = evals + select(wanted, 1.0f, 0.0f);
        const Vec3s position = fma(direction, (low + high) * 0.5f, origin);
        Floats weight = zero_unless(wanted, (high - low) * exp(-before * frame.style.view_depth) *
                                                mean_transmittance(depth * frame.style.view_depth));
        if (frame.style.range < StyleSettings().range)
            weight = weight * style_fade(frame.style, frame.camera, position);
        const float* extinction = packet.scratch.extinction.data() + 16 * media.size() * k;
        const Vec3s source = scattered_fluence(*frame.fluence, media, position, direction,
                                               [&](size_t m) HWY_ATTR { return load(extinction + 16 * m); });
        radiance = fma(source, weight, radiance);
    }
    alignas(64) float rgb[3][16], counts[16];
    store(radiance.x, rgb[0]), store(radiance.y, rgb[1]), store(radiance.z, rgb[2]), store(evals, counts);
    for (size_t i = 0; i < packet.batch.rays.size(); ++i) {
        packet.radiance[i] += vec3(rgb[0][i], rgb[1][i], rgb[2][i]);
        packet.evals[i] += static_cast<int>(counts[i]);
    }
}

// For homogeneous and height fog: at least one node per grid cell and per half optical depth.
void add_fluence_nodes(Packet& packet) {
    const FluenceGrid& grid = *packet.frame.fluence;
    const RaySegments& cuts = packet.scratch.cuts;
    packet.spread = Spread::length;
    for (size_t i = 0; i < packet.batch.rays.size(); ++i) {
        const Ray& ray = packet.batch.rays[i];
        const Interval<float> inside = clip(grid.bounds, ray.origin, ray.direction, {0, ray.t_max});
        double before = 0; // approximate optical depth
        for (int k = 0; k < cuts.pieces[i] && before < packet.frame.opaque; ++k) {
            const float* at = cuts.at.data() + 16 * static_cast<size_t>(k) + i;
            const double low = std::max(at[0], inside.low), high = std::min(at[16], inside.high);
            const double dimming = extinction_at(packet.frame, ray.at(0.5f * (at[0] + at[16])));
            before += dimming * (at[16] - at[0]);
            const double finest = std::max(1 / double(grid.cell), dimming / deepest_part);
            const int parts = static_cast<int>(std::min(std::ceil((high - low) * finest), max_parts));
            for (int part = 0; part < parts; ++part)
                push_node(packet, multiple_light, i, k, low, high, (part + 0.5) / parts, 1.0 / parts);
        }
    }
    add_nodes(packet, multiple_light);
}

void add_fluence(Packet& packet) {
    if (!packet.frame.fluence) return;
    packet.frame.sampled ? add_fluence_steps(packet) : add_fluence_nodes(packet);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
