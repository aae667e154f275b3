// Shells: the sides of shadow volumes drawn as sheets of light; part of the single-scattering kernel (see
// base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_INTEGRATE_SINGLE_SCATTERING_SHELLS_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_SINGLE_SCATTERING_SHELLS_SIMD_H
#undef TYNDALL_INTEGRATE_SINGLE_SCATTERING_SHELLS_SIMD_H
#else
#define TYNDALL_INTEGRATE_SINGLE_SCATTERING_SHELLS_SIMD_H
#endif

#include "integrate/single_scattering/single_scattering_simd.h"
#include "scene/lights/light_reach.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Intersection of a ray with a sheet.
struct Shell {
    double t, behind; // behind: meters behind the edge that casts it
    int change = 0;   // of the shadow volume count
};

// Adds the surface of a spot light's cone, halfway down its soft edge; it does not change the count.
void append_mantle(const Light& light, const Ray& ray, std::vector<Shell>& shells) {
    if (!has_cone(light)) return;
    const dvec3 origin(ray.origin), direction(ray.direction), apex(light.position);
    const double angle = std::acos(0.5 * (std::cos(double(light.inner_cone)) + std::cos(double(light.outer_cone))));
    const Interval<double> beam = inside_cone(apex, glm::normalize(dvec3(light.direction)), angle, origin, direction);
    for (const double t : {beam.low, beam.high})
        if (!beam.empty() && std::isfinite(t)) shells.push_back({t, glm::distance(origin + t * direction, apex)});
}

// Pushes a node wherever the ray crosses a side between light and shadow, as bright as a given length of lit fog.
void push_shells(Packet& packet, int light, size_t ray, int dark, Interval<double> reached) {
    static thread_local std::vector<Shell> shells;
    shells.clear();
    for (const ShadowCrossing& crossing : packet.scratch.crossings)
        if (std::isfinite(crossing.t[ray]))
            shells.push_back({crossing.t[ray], crossing.behind[ray], static_cast<int>(crossing.change[ray])});
    append_mantle(packet.frame.snapshot.lights[static_cast<size_t>(light)], packet.batch.rays[ray], shells);
    std::sort(shells.begin(), shells.end(), [](const Shell& a, const Shell& b) { return a.t < b.t; });
    const Shells& look = *packet.frame.shells;
    const RaySegments& cuts = packet.scratch.cuts;
    int cut = 0;
    for (const Shell& shell : shells) {
        const bool was_dark = dark > 0;
        dark += shell.change;
        const bool edge = shell.change ? (dark > 0) != was_dark : !was_dark;
        if (!edge || !(shell.behind > 0) || shell.t < reached.low || shell.t > reached.high) continue;
        const double left = 1 - shell.behind / look.length;
        if (left <= 0) continue;
        while (cut + 1 < cuts.pieces[ray] && cuts.at[16 * static_cast<size_t>(cut + 1) + ray] < shell.t) ++cut;
        push_node(packet, light, ray, cut, shell.t, shell.t, 0, look.intensity * look.length * left * left);
    }
}
}
}
HWY_AFTER_NAMESPACE();
#endif
