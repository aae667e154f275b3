#include "integrate/lights/lamps.h"

#include "integrate/lights/fire_lamps.h"
#include "integrate/lights/mesh_lamps.h"

namespace tyndall {
float ball_radius(dvec3 spread) { return std::sqrt(5.0f / 3 * float(spread.x + spread.y + spread.z)); }

Snapshot with_lamps(const Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms) {
    Snapshot lit = with_fire_lamps(with_mean_environment(with_terms(stylized(snapshot, style), terms)));
    return with_mesh_lamps(std::move(lit), style, terms.emission);
}

ScatterFunction with_lamps_as_emission(size_t lights, size_t all, ScatterFunction scatter) {
    if (all == lights) return scatter;
    return [lights, all, scatter = std::move(scatter)](const RayBatch& batch, std::span<Scatter> results) {
        if (batch.parts.empty()) return scatter(batch, results);
        RayBatch own = batch;
        std::vector<vec3> parts(batch.rays.size() * part_count(all), vec3(0));
        own.parts = parts;
        scatter(own, results);
        for (size_t ray = 0; ray < batch.rays.size(); ++ray) {
            for (size_t i = 0; i < lights; ++i) batch.part(ray, i) += own.part(ray, i);
            for (size_t i = lights; i < all; ++i)
                batch.part(ray, batch.index_of(OtherLight::emission)) += own.part(ray, i);
            for (const OtherLight other : {OtherLight::ambient, OtherLight::emission, OtherLight::multiple})
                batch.part(ray, batch.index_of(other)) += own.part(ray, own.index_of(other));
        }
    };
}
}
