#include "modes/march/exact.h"

#include "modes/march/exact_steps.h"
#include "scene/lights/light_filter.h"
#include "volume/rays/emission_nodes.h"

#include <utility>

namespace tyndall {
namespace {
// Emission of a field, at its own nodes.
dvec3 light_of_field(RayMarch& on, const Medium& field) {
    const FogPieces& fog = on.scratch.fog;
    dvec3 sum(0);
    size_t piece = 0;
    find_emission_nodes(*field.density.bricks, on.ray, [&](EmissionNode node) {
        while (piece + 1 < fog.pieces.size() && fog.pieces[piece + 1].low <= node.t) ++piece;
        double share = 1; // in front of all fog, or without any
        if (!fog.pieces.empty() && node.t > fog.pieces[piece].low)
            share = seen(on, piece, std::min<double>(node.t, fog.pieces[piece].high));
        else if (fades(on.frame.style))
            share = style_fade(on.frame.style, eye_distance(on.frame.camera, on.ray.at(node.t)));
        sum += share * node.length * dvec3(emission_at(field, on.ray.at(node.t)));
        ++on.nodes;
    });
    return sum;
}

// Emission and ambient light of all fog, lit or not.
struct OtherSums {
    dvec3 ambient{0}, emission{0};
};
OtherSums other_light(RayMarch& on) {
    const FogPieces& fog = on.scratch.fog;
    OtherSums sum;
    at_nodes(on, [&](size_t piece, double t, double weight) {
        for (size_t m = 0; m < fog.media; ++m) {
            const Optics& optics = on.frame.snapshot.media[m].optics;
            const dvec3 per_density =
                double(gray_extinction(optics)) * dvec3(albedo_on(on, optics, t) * on.frame.snapshot.ambient);
            const double density = weight * fog.density(piece, m, t);
            sum.ambient += density * per_density, sum.emission += density * dvec3(optics.emission.radiance);
        }
    });
    for (const Medium& field : on.frame.fields) sum.emission += light_of_field(on, field);
    return sum;
}

// Multiply scattered light, in steps no longer than a cell of the fluence grid.
dvec3 multiply_scattered(RayMarch& on) {
    const FogPieces& fog = on.scratch.fog;
    const FluenceGrid& grid = *on.frame.fluence;
    const double longest = std::exchange(on.longest, std::min<double>(on.longest, grid.cell));
    dvec3 sum(0);
    at_nodes(on, [&](size_t piece, double t, double weight) {
        const FluenceAt at = fluence_at(grid, vec3(on.at(t)));
        for (size_t m = 0; m < fog.media; ++m) {
            const Optics& optics = on.frame.snapshot.media[m].optics;
            const dvec3 scattered(albedo_on(on, optics, t) * scattered_fluence(at, on.ray.direction, optics.phase));
            sum += weight * fog.density(piece, m, t) * fog.extinction[m] * scattered;
        }
    });
    on.longest = longest;
    return sum;
}

// Light scattered towards the eye at a node of given weight, before attenuation on its way from the light.
dvec3 scattered_at(const RayMarch& on, size_t piece, double t, double weight) {
    const FogPieces& fog = on.scratch.fog;
    const LightSamplesAt light_at = arriving_at(on.scratch.along, t);
    const double cosine = glm::dot(light_at.to_light, dvec3(on.ray.direction));
    dvec3 scattering(0);
    for (size_t m = 0; m < fog.media; ++m) {
        const double density = fog.density(piece, m, t);
        if (density == 0) continue;
        const Optics& optics = on.frame.snapshot.media[m].optics;
        scattering += density * fog.extinction[m] * phase_value_of<double>(optics.phase, cosine) *
                      dvec3(albedo_on(on, optics, t));
    }
    return scattering * (weight * light_at.amount * seen(on, piece, t)) * light_at.tint;
}

// Light of scratch.along along the ray: over the lit segments, by pieces of fog.
dvec3 light_along_ray(RayMarch& on, size_t light_index) {
    const FogPieces& fog = on.scratch.fog;
    const LightAlong& along = on.scratch.along;
    const LightDepth& depth = on.frame.depths[light_index];
    const auto& occluders = shadow_casters(*along.light, on.frame.snapshot);
    const bool slow = !depth.marched.empty() || (occluders && occluders->has_alpha());
    const int marches = slow ? on.frame.rule->settings.light_marches : 0;
    on.scratch.nodes.clear();
    LitNodes nodes{on.frame, depth, along};
    const auto add = [&](size_t piece, double t, double weight) {
        const dvec3 light = scattered_at(on, piece, t, weight);
        // Negligible: a million such nodes would not change the seventh digit.
        if (glm::all(glm::lessThanEqual(light, 1e-13 * nodes.sum))) return;
        ++on.nodes;
        if (marches > 0)
            on.scratch.nodes.push_back({on.at(t), light});
        else
            nodes.add({on.at(t), light});
    };

    size_t piece = 0;
    for (const auto& [lit, share] : on.scratch.lit) {
        while (piece < fog.pieces.size() && fog.pieces[piece].high <= lit.low) ++piece;
        for (; piece < fog.pieces.size() && fog.pieces[piece].low < lit.high; ++piece) {
            const double low = std::max(fog.pieces[piece].low, lit.low);
            const double high = std::min(fog.pieces[piece].high, lit.high);
            split_at_lobes(on, piece, low, high, along, [&](double from, double to) {
                const bool across = crosses_cone(along, {low, high}, from, to);
                visit_nodes(along, gauss_legendre(across ? nodes_across_cone : nodes_per_step), from, to,
                            [&, part = share](double t, double weight) { add(piece, t, part * weight); });
            });
            if (fog.pieces[piece].high >= lit.high) break;
        }
    }
    if (static_cast<size_t>(marches) < on.scratch.nodes.size())
        nodes.add_drawn(on.scratch.nodes, marches, on.jitter);
    else
        for (const LitNode& node : on.scratch.nodes) nodes.add(node);
    nodes.attenuate();
    on.nodes += nodes.work;
    return nodes.sum * dvec3(along.light->intensity * along.light->volume_scale);
}

// Light of one light along the ray. The lit segments of its sample points are merged, each part with the fraction of
// points it sees; with alpha shadows they stay separate, as each shadow ray needs its own point.
dvec3 light_from(RayMarch& on, const RayBatch& batch, size_t ray, size_t light_index) {
    const SingleScattering& frame = on.frame;
    const Light& light = frame.snapshot.lights[light_index];
    const auto& occluders = shadow_casters(light, frame.snapshot);
    const bool apart = occluders && occluders->has_alpha();
    static const ShadowSlices none;
    const ShadowSlices* slices = occluders ? &occluders->shadow_slices() : &none;
    const uint32_t count = is_soft(light) ? static_cast<uint32_t>(frame.light_points) : 1;
    std::vector<LitPart>& lit = on.scratch.lit;
    std::vector<LitEnd>& ends = on.scratch.ends;
    dvec3 sum(0);
    on.detail = light.filter ? finest_detail(*light.filter) : 0;
    ends.clear();
    for (uint32_t k = 0; k < count; ++k) {
        find_light(light, light_point(batch, ray, light, light_index, k, count), on.ray, slices, frame.snapshot.media,
                   on.scratch.along);
        lit.clear();
        for (const Interval<double>& stretch : on.scratch.along.lit) {
            lit.push_back({stretch, 1.0 / count});
            ends.push_back({stretch.low, 1}), ends.push_back({stretch.high, -1});
        }
        if (apart || count == 1) sum += light_along_ray(on, light_index);
    }
    if (apart || count == 1) return sum;

    std::sort(ends.begin(), ends.end(), [](const LitEnd& a, const LitEnd& b) { return a.t < b.t; });
    lit.clear();
    int seen = 0;
    for (size_t i = 0; i + 1 < ends.size(); ++i) {
        seen += ends[i].change;
        if (seen > 0 && ends[i].t < ends[i + 1].t)
            lit.push_back({{ends[i].t, ends[i + 1].t}, static_cast<double>(seen) / count});
    }
    return light_along_ray(on, light_index);
}

void march_ray(const SingleScattering& frame, const RayBatch& batch, size_t ray_index, Scatter& result) {
    static thread_local MarchScratch scratch;
    const Ray& ray = batch.rays[ray_index];
    RayMarch on{frame, ray, batch.jitter.empty() ? 0.5f : batch.jitter[ray_index], scratch};
    const FogPieces& fog = scratch.fog;
    find_fog(ray, frame.snapshot.media, frame.rule->settings.min_transmittance, scratch.fog);
    result = {};
    if (fog.pieces.empty() && frame.fields.empty()) return;

    const double stretch = fog.pieces.empty() ? 0 : fog.pieces.back().high - fog.pieces.front().low;
    on.longest = frame.rule->settings.step_share * stretch;
    dvec3 sum(0);
    const auto add = [&](size_t index, const dvec3& light) {
        sum += light;
        if (!batch.parts.empty()) batch.part(ray_index, index) += vec3(light);
    };
    const auto [ambient, emission] = other_light(on);
    add(batch.index_of(OtherLight::ambient), ambient), add(batch.index_of(OtherLight::emission), emission);
    if (frame.fluence) add(batch.index_of(OtherLight::multiple), multiply_scattered(on));
    const std::vector<Light>& lights = frame.snapshot.lights;
    for (size_t l = 0; l < lights.size(); ++l) add(l, light_from(on, batch, ray_index, l));
    result.radiance = vec3(sum);
    result.transmittance = static_cast<float>(std::exp(-fog.depth));
    result.steps = on.nodes;
}
}

void march_exact(const SingleScattering& frame, const RayBatch& batch, std::span<Scatter> results) {
    for (size_t i = 0; i < batch.rays.size(); ++i) march_ray(frame, batch, i, results[i]);
}
}
