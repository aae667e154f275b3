// Shells: the sides of shadow volumes as sheets of light, inside the kernel of shadow-volume (see base/simd.h for how
// such files are compiled).
#if defined(TYNDALL_MODES_SHADOW_VOLUME_SHELLS_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_SHADOW_VOLUME_SHELLS_SIMD_H
#undef TYNDALL_MODES_SHADOW_VOLUME_SHELLS_SIMD_H
#else
#define TYNDALL_MODES_SHADOW_VOLUME_SHELLS_SIMD_H
#endif

#include "modes/shadow_volume_simd.h"
#include "scene/cone.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// The mantle of a spot's beam, half way down its soft edge: crossings that change no count.
void append_mantle(const Light& light, const Ray& ray, std::vector<ShadowCrossing>& crossings) {
    if (light.kind != LightKind::spot) return;
    const dvec3 origin(ray.origin), direction(ray.direction), apex(light.position);
    const double angle = std::acos(0.5 * (std::cos(double(light.inner_cone)) + std::cos(double(light.outer_cone))));
    const Stretch beam = inside_cone(apex, glm::normalize(dvec3(light.direction)), angle, origin, direction);
    for (const double t : {beam.low, beam.high})
        if (!beam.empty() && std::isfinite(t))
            crossings.push_back({t, static_cast<float>(glm::distance(origin + t * direction, apex)), 0});
}

// A sheet of light wherever the ray goes through a side from light into shadow or back: as bright as some metres of the
// fog.
void push_shells(Packet& packet, int light, size_t ray, int dark, Stretch reached) {
    const ShadowVolumeSettings& settings = packet.frame.settings;
    const FogCuts& cuts = packet.scratch.cuts;
    std::vector<ShadowCrossing>& crossings = packet.scratch.crossings[ray];
    append_mantle(packet.frame.snapshot.lights[static_cast<size_t>(light)], packet.batch.rays[ray], crossings);
    std::sort(crossings.begin(), crossings.end(),
              [](const ShadowCrossing& a, const ShadowCrossing& b) { return a.t < b.t; });
    int cut = 0;
    for (const ShadowCrossing& crossing : crossings) {
        const bool was_dark = dark > 0;
        dark += crossing.change;
        const bool edge = crossing.change ? (dark > 0) != was_dark : !was_dark;
        if (!edge || !(crossing.behind > 0) || crossing.t < reached.low || crossing.t > reached.high) continue;
        const double left = 1 - crossing.behind / settings.shell_length;
        if (left <= 0) continue;
        while (cut + 1 < cuts.pieces[ray] && cuts.at[16 * static_cast<size_t>(cut + 1) + ray] < crossing.t) ++cut;
        push_node(packet, light, ray, cut, crossing.t, crossing.t, 0,
                  settings.shell_intensity * settings.shell_length * left * left);
    }
}
}
}
HWY_AFTER_NAMESPACE();
#endif
