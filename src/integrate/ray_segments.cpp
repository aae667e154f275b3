// Splits rays into segments: at kinks of homogeneous and height fog, or into steps.
#include "integrate/single_scattering/single_scattering.h"
#include "volume/medium.h"

#include "volume/rays/fog_reach.h"
#include "volume/rays/spans.h"

namespace tyndall {
namespace {
constexpr double max_depth = 2; // maximum optical depth between cuts

// Adds cuts at heights between which the density of height fog changes by a factor of e^1.5.
void add_levels(const Medium& medium, const Ray& ray, Interval<double> inside, std::vector<double>& cuts) {
    const double dy = ray.direction.y, y = ray.origin.y;
    if (std::abs(dy) < 1e-12) return;
    for (int level = 0; level <= 12; ++level) {
        const double t = (medium.density.height_base + 1.5 * level * medium.density.height_falloff - y) / dy;
        if (t > inside.low && t < inside.high) cuts.push_back(t);
    }
}

// Adds cuts where the path from the ray to a light starts to leave a medium's box through a different face, because the
// transmittance to the light has a kink there. On the path x + u·(light - far·x), far = 0 for distant lights, the faces
// f of axes i and j are hit at the same u where (f_i - x_i)(light_j - far·x_j) = (f_j - x_j)(light_i - far·x_i), which
// is linear in x.
void add_exits(const Medium& medium, const Light& light, const Ray& ray, Interval<double> inside,
               std::vector<double>& cuts) {
    const double far = is_distant(light) ? 0 : 1;
    const glm::dvec4 source = far == 0 ? glm::dvec4(-dvec3(light.direction), 0) : glm::dvec4(light.position, 1);
    const dvec3 to(dmat4(medium.density.world_to_local) * source);
    const LocalRay local = local_ray(medium.density.world_to_local, ray);
    dvec3 face(0);
    bool leaves[3];
    for (int i = 0; i < 3; ++i) {
        const double low = medium.density.bounds.low[i], high = medium.density.bounds.high[i];
        const double beyond = far == 0 ? 0 : high, before = far == 0 ? 0 : low;
        face[i] = to[i] > beyond ? high : low;
        leaves[i] = (to[i] > beyond || to[i] < before) && std::isfinite(face[i]);
    }
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        if (!leaves[i] || !leaves[j]) continue;
        const double of_i = far * face[j] - to[j], of_j = to[i] - far * face[i];
        const double along = of_i * local.direction[i] + of_j * local.direction[j];
        const double t = -(face[i] * to[j] - face[j] * to[i] + of_i * local.origin[i] + of_j * local.origin[j]) / along;
        if (!(t > inside.low && t < inside.high)) continue;
        const dvec3 x = local.origin + t * local.direction, way = to - far * x;
        const double u = (face[i] - x[i]) / way[i];
        if (!leaves[k] || (face[k] - x[k]) / way[k] >= u) cuts.push_back(t);
    }
}

// Divides low..high into equal parts of at most max_depth optical depth, estimated at the midpoint.
void divide(const SingleScattering& frame, const Ray& ray, double low, double high, std::vector<double>& cuts) {
    double extinction = 0;
    const vec3 middle = ray.at(static_cast<float>(0.5 * (low + high)));
    for (const Medium& medium : frame.snapshot.media)
        extinction += double(gray_extinction(medium.optics)) * density_at(medium, middle);
    const int parts = static_cast<int>(std::clamp(std::ceil(extinction * (high - low) / max_depth), 1.0, 64.0));
    for (int i = 1; i <= parts; ++i) cuts.push_back(low + (high - low) * i / parts);
}

// Finds cuts for homogeneous and height fog, which is smooth between its kinks.
void find_even_cuts(const SingleScattering& frame, const Ray& ray, std::vector<double>& cuts) {
    static thread_local std::vector<double> kinks;
    kinks.clear();
    const double end = std::min<double>(ray.t_max, horizon(ray, frame.snapshot.media));
    for (const Medium& medium : frame.snapshot.media) {
        const Interval<double> inside =
            clip(medium.density.bounds, local_ray(medium.density.world_to_local, ray), {0, end});
        if (inside.empty()) continue;
        kinks.push_back(inside.low), kinks.push_back(inside.high);
        if (medium.density.kind == DensityKind::height) add_levels(medium, ray, inside, kinks);
        for (const Light& light : frame.snapshot.lights) add_exits(medium, light, ray, inside, kinks);
    }
    if (kinks.empty()) return;
    std::sort(kinks.begin(), kinks.end());
    cuts.push_back(kinks.front());
    for (size_t i = 1; i < kinks.size(); ++i)
        if (kinks[i] > kinks[i - 1]) divide(frame, ray, kinks[i - 1], kinks[i], cuts);
}

// The fog of a ray in three parts: before, inside and beyond the scene, which gets most of the steps.
struct Thirds {
    float at[4] = {};
};
Thirds divide_fog(const SingleScattering& frame, const Ray& ray) {
    const float end = static_cast<float>(std::min<double>(ray.t_max, horizon(ray, frame.snapshot.media)));
    const Interval<float> fog = fog_interval(frame.snapshot.media, {ray.origin, ray.direction, end});
    const Interval<float> scene = scene_part(frame.snapshot, ray, fog);
    return {{fog.low, scene.low, scene.high, fog.high}};
}

void find_steps(const SingleScattering& frame, std::span<const Ray> rays, RaySegments& cuts) {
    float low[3][16] = {}, length[3][16] = {};
    bool used[3] = {};
    for (size_t ray = 0; ray < rays.size(); ++ray) {
        const Thirds thirds = divide_fog(frame, rays[ray]);
        for (int i = 0; i < 3; ++i) {
            low[i][ray] = thirds.at[i], length[i][ray] = thirds.at[i + 1] - thirds.at[i];
            used[i] |= length[i][ray] > 0;
        }
    }
    const int steps = frame.steps, few = std::max(steps / 4, 1);
    const int counts[3] = {used[0] ? few : 0, used[1] ? steps : 0, used[2] ? few : 0};
    cuts.max_pieces = counts[0] + counts[1] + counts[2];
    cuts.at.resize(16 * (static_cast<size_t>(cuts.max_pieces) + 1));
    float* at = cuts.at.data();
    for (int ray = 0; ray < 16; ++ray) at[ray] = low[0][ray], cuts.pieces[ray] = cuts.max_pieces;
    for (int part = 0; part < 3; ++part)
        for (int k = 1; k <= counts[part]; ++k) {
            const float share = static_cast<float>(k) / static_cast<float>(counts[part]);
            at += 16;
            for (int ray = 0; ray < 16; ++ray) at[ray] = low[part][ray] + length[part][ray] * share;
        }
    for (int ray = 0; ray < 16; ++ray)
        if (!(at[ray] > low[0][ray])) cuts.pieces[ray] = 0;
}

// Finds cuts at the ends of the steps of a rule; gaps between steps are empty.
void find_step_cuts(const SingleScattering& frame, const Ray& ray, std::vector<double>& cuts) {
    static thread_local std::vector<Step> steps;
    steps.clear();
    append_march_steps(*frame.rule, frame.snapshot, ray, steps);
    for (const Step& step : steps) {
        if (cuts.empty() || cuts.back() < step.low) cuts.push_back(step.low);
        cuts.push_back(step.high);
    }
}
}

void find_segments(const SingleScattering& frame, std::span<const Ray> rays, RaySegments& cuts) {
    if (frame.sampled && !frame.rule) return find_steps(frame, rays, cuts);
    static thread_local std::vector<double> own;
    cuts.max_pieces = 0;
    for (size_t ray = 0; ray < 16; ++ray) {
        own.clear();
        if (ray < rays.size())
            frame.sampled ? find_step_cuts(frame, rays[ray], own) : find_even_cuts(frame, rays[ray], own);
        if (cuts.at.size() < 16 * (own.size() + 1)) cuts.at.resize(16 * (own.size() + 1));
        cuts.pieces[ray] = std::max(static_cast<int>(own.size()) - 1, 0);
        cuts.max_pieces = std::max(cuts.max_pieces, cuts.pieces[ray]);
        cuts.at[ray] = 0;
        for (size_t k = 0; k < own.size(); ++k) cuts.at[16 * k + ray] = static_cast<float>(own[k]);
    }
    for (size_t ray = 0; ray < 16; ++ray)
        for (int k = cuts.pieces[ray] + 1; k <= cuts.max_pieces; ++k)
            cuts.at[16 * static_cast<size_t>(k) + ray] = cuts.high(ray);
}
}
