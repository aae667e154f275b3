// Steps that are fully lit by a distant light, processed for all rays at once; part of the single-scattering kernel
// (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_INTEGRATE_SINGLE_SCATTERING_FULL_STEPS_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_SINGLE_SCATTERING_FULL_STEPS_SIMD_H
#undef TYNDALL_INTEGRATE_SINGLE_SCATTERING_FULL_STEPS_SIMD_H
#else
#define TYNDALL_INTEGRATE_SINGLE_SCATTERING_FULL_STEPS_SIMD_H
#endif

#include "integrate/single_scattering/single_scattering_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Where a step is evaluated: in the middle or, in equal steps, which may be deep, at the mean of what is seen of them:
// 1/x - 1/(e^x - 1) of the way through a depth x.
HWY_INLINE Floats seen_at(const SingleScattering& frame, const Floats& low, const Floats& high, const Floats& inside) {
    if (frame.rule) return (low + high) * 0.5f;
    const Floats x = inside * frame.style.view_depth, deep = max(x, 0.1f);
    const Floats share = (1.0f - exp(-deep) / mean_transmittance(deep)) / deep;
    return fma(select(x < 0.1f, fma(x, -1.0f / 12, 0.5f), share), high - low, low);
}

// Adds the steps marked in `whole`, whose extinction at the midpoint is already known.
void add_full_steps(Packet& packet, size_t index) {
    const SingleScattering& frame = packet.frame;
    const Light& light = frame.snapshot.lights[index];
    const std::vector<Medium>& media = frame.snapshot.media;
    const Vec3s origin = Packet::rays(packet.origin), direction = Packet::rays(packet.direction);
    const float* at = packet.scratch.cuts.at.data();
    const float* depths = packet.scratch.depth.data();

    // The light direction is the same everywhere, so evaluate the phase functions once per ray.
    const Floats cosine = dot(splat(-light.direction), direction);
    std::vector<std::array<float, 16>>& phase = packet.scratch.phase;
    phase.resize(media.size());
    for (size_t m = 0; m < media.size(); ++m) store(phase_value(media[m].optics.phase, cosine), phase[m].data());

    Vec3s radiance = splat(vec3(0));
    Floats evals = 0.0f;
    for (size_t k = 0; k < static_cast<size_t>(packet.scratch.cuts.max_pieces); ++k) {
        const Floats share = load(packet.scratch.whole.data() + 16 * k);
        const Mask16 wanted = share > 0.0f;
        if (!any(wanted)) continue;
        evals = evals + select(wanted, 1.0f, 0.0f);
        const Floats low = load(at + 16 * k), high = load(at + 16 * (k + 1));
        const Floats before = load(depths + 16 * k), after = load(depths + 16 * (k + 1));
        const Vec3s position = fma(direction, seen_at(frame, low, high, after - before), origin);
        Floats weight = share * (high - low) *
                        seen_through(frame, (before + after) * 0.5f, after - before,
                                     light_depth16(frame.depths[index], position, wanted));
        if (frame.style.range < StyleSettings().range)
            weight = weight * style_fade(frame.style, frame.camera, position);
        const float* extinction = packet.scratch.extinction.data() + 16 * media.size() * k;
        for (size_t m = 0; m < media.size(); ++m)
            radiance = fma(albedo16(media[m].optics, position),
                           weight * load(extinction + 16 * m) * load(phase[m].data()), radiance);
    }
    const vec3 color = light.intensity * light.volume_scale;
    alignas(64) float rgb[3][16], counts[16];
    store(radiance.x, rgb[0]), store(radiance.y, rgb[1]), store(radiance.z, rgb[2]), store(evals, counts);
    for (size_t i = 0; i < packet.batch.rays.size(); ++i) {
        packet.radiance[i] += color * vec3(rgb[0][i], rgb[1][i], rgb[2][i]);
        packet.evals[i] += static_cast<int>(counts[i]) * (1 + march_work(frame.depths[index]));
    }
}
}
}
HWY_AFTER_NAMESPACE();
#endif
