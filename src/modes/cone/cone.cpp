// Analytic volume lights: single scattering of each light in homogeneous fog, in closed form and without shadows.
#include "modes/cone/cone.h"
#include "modes/cone/limitations.h"
#include "modes/cone/settings.h"
#include "modes/resolution.h"

#include "integrate/lights/lamps.h"
#include "integrate/style.h"
#include "modes/fog_buffer.h"
#include "modes/history.h"
#include "modes/mode.h"
#include "scene/lights/light_filter.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "volume/bricks/bricks.h"

namespace tyndall {
namespace {
Medium seen_from(const Medium& medium, dvec3 anchor) {
    Medium moved = medium;
    moved.density.world_to_local[3] = vec4(dmat4(medium.density.world_to_local) * glm::dvec4(anchor, 1));
    moved.density.height_base = static_cast<float>(medium.density.height_base - anchor.y);
    return moved;
}

// Coordinates of a box's faces along one axis through which rays to the light can leave it: those that face the light
// or, with `both` (for points outside the box too), either face.
std::vector<double> faces(const Medium& medium, int axis, double towards_low, double towards_high, bool both) {
    const double low = medium.density.bounds.low[axis], high = medium.density.bounds.high[axis];
    std::vector<double> result;
    if (std::isfinite(low) && (both || towards_low > 0)) result.push_back(low);
    if (std::isfinite(high) && (both || towards_high > 0)) result.push_back(high);
    return result;
}

// Planes through the light and the edges of a box.
void add_edge_planes(const Medium& medium, const Light& light, bool both, std::vector<vec4>& planes) {
    const dmat4 m(medium.density.world_to_local);
    const bool sun = is_distant(light);
    const dvec3 apex(m[3]), travel = glm::dmat3(m) * dvec3(light.direction); // local space; the light is the anchor
    const auto faces_of = [&](int axis) {
        const double low = medium.density.bounds.low[axis], high = medium.density.bounds.high[axis];
        if (sun) return faces(medium, axis, travel[axis], -travel[axis], both);
        return faces(medium, axis, low - apex[axis], apex[axis] - high, both);
    };
    for (int i = 0; i < 3; ++i)
        for (const double fi : faces_of(i))
            for (int j = i + 1; j < 3; ++j)
                for (const double fj : faces_of(j)) {
                    // n·(q - edge) = 0, with n perpendicular to the edge and to the direction to the light.
                    const double ni = sun ? travel[j] : fj - apex[j], nj = sun ? -travel[i] : apex[i] - fi;
                    const dvec3 row_i(m[0][i], m[1][i], m[2][i]), row_j(m[0][j], m[1][j], m[2][j]);
                    const dvec3 normal = ni * row_i + nj * row_j;
                    const double offset = ni * (apex[i] - fi) + nj * (apex[j] - fj);
                    planes.push_back(vec4(vec3(normal), static_cast<float>(offset)));
                }
}

bool contains(const Box& box, dvec3 point) {
    return glm::all(glm::greaterThanEqual(point, dvec3(box.low))) &&
           glm::all(glm::lessThanEqual(point, dvec3(box.high)));
}

bool endless(const Medium& medium) {
    return glm::all(glm::isinf(medium.density.bounds.low)) && glm::all(glm::isinf(medium.density.bounds.high));
}

// `light` null: for transmittance, emission and ambient light only.
AnchoredFog anchored(std::span<const Medium> media, dvec3 anchor, const Light* light) {
    AnchoredFog fog;
    fog.anchor = anchor;
    fog.direct = light && !is_distant(*light);
    for (const Medium& medium : media) {
        const Medium& moved = fog.media.emplace_back(seen_from(medium, anchor));
        const bool height = moved.density.kind == DensityKind::height;
        const bool around = contains(moved.density.bounds, dvec3(moved.density.world_to_local[3]));
        fog.direct &= !height && (endless(moved) || (media.size() == 1 && around));
        if (height) fog.kinks.push_back(vec4(0, 1, 0, -moved.density.height_base));
        if (light) add_edge_planes(moved, *light, media.size() > 1, fog.kinks);
    }
    return fog;
}

ConeEdges edges_of(const Light& light, const ConeSettings& settings) {
    const auto versine = [](double angle) { return 2 * std::sin(0.5 * angle) * std::sin(0.5 * angle); };
    const double outer = light.outer_cone, soft = settings.inner * outer;
    const double scale = 1 / std::max(versine(outer) - versine(light.inner_cone), min_cone_edge(outer));
    const double even = settings.edge == ConeEdge::soft ? versine(soft) : std::max(versine(outer) - 1 / scale, 0.0);
    ConeEdges edges;
    edges.cosine = static_cast<float>(std::max(std::cos(outer), 0.0)), edges.sine = static_cast<float>(std::sin(outer));
    edges.even_cosine = static_cast<float>(1 - even);
    edges.even_sine = static_cast<float>(std::sqrt(even * (2 - even)));
    edges.versine = static_cast<float>(versine(outer)), edges.scale = static_cast<float>(scale);
    edges.angle = light.outer_cone, edges.soft_scale = static_cast<float>(1 / std::max(outer - soft, 1e-6));
    return edges;
}

ConeLight cone_light(const Light& light, const Snapshot& snapshot, const Cone& cone) {
    ConeLight result;
    const bool sun = is_distant(light);
    result.light = light;
    result.fog = anchored(snapshot.media, sun ? dvec3(cone.eye) : dvec3(light.position), &light);
    result.edges = edges_of(light, cone.settings);
    result.reach = capped_radius(light);
    if (has_cone(light) && light.outer_cone > 0)
        result.near_plane = static_cast<float>(cone.settings.near_radius / std::tan(double(light.outer_cone)));
    result.light.position = vec3(0);
    if (light.filter) result.filter_level = gobo_mip_level(*light.filter, filter_node_angle(light));
    result.linear_range = std::isinf(light.range) ? glm::length(snapshot.bounds.size()) : light.range;
    return result;
}
}

float AnchoredFog::extinction() const {
    float sum = 0;
    for (const Medium& medium : media) sum += gray_extinction(medium.optics);
    return sum;
}

float filter_node_angle(const Light& light) { return cone_angle(light) / (8 * filter_pieces_of_ray); }

Cone make_cone(const View& view, const Snapshot& snapshot, const Settings& settings) {
    Snapshot seen = with_lamps(snapshot, settings.style, settings.terms);
    Cone cone;
    cone.settings = settings.of<ConeSettings>(), cone.style = settings.style, cone.eye = view.camera.position;
    cone.noise_rise = static_cast<float>(settings.of<ConeSettings>().noise_speed * snapshot.seconds);
    cone.casts = snapshot.occluders && !snapshot.occluders->empty();
    for (const Medium& medium : seen.media)
        if (medium.density.kind == DensityKind::bricks) cone.grids.push_back(medium.density.bricks->bounds);
    seen.media = homogeneous_media(seen.media);
    cone.lobe = lobe_cuts(seen.media);
    cone.fog = anchored(seen.media, dvec3(cone.eye), nullptr);
    for (const Medium& medium : seen.media) {
        cone.ambient.push_back(medium.optics.albedo * seen.ambient);
        cone.emission.push_back(source_radiance(medium.optics, vec3(0)));
    }
    for (const Light& light : seen.lights) cone.lights.push_back(cone_light(light, seen, cone));
    return cone;
}

ScatterFunction prepare_cone(const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
    const auto cone = std::make_shared<const Cone>(make_cone(view, snapshot, settings));
    ScatterFunction scatter = [cone](const RayBatch& batch, std::span<Scatter> results) {
        cone_packet(*cone, batch, results);
    };
    scatter = with_lamps_as_emission(snapshot.lights.size(), cone->lights.size(), std::move(scatter));
    if (history) update_history(*history, view, snapshot, settings);
    if (settings.of<ConeSettings>().resolution == Resolution::full && !history) return scatter;
    return from_fog_buffer(view, snapshot, {settings.of<ConeSettings>().resolution}, std::move(scatter), history);
}

Mode cone_mode() {
    return {.name = "cone",
            .summary = "closed forms for the light of spots, points and suns in homogeneous fog, without shadows",
            .use = "spots and lamps that nothing obstructs, in homogeneous fog: exact and the fastest",
            .accuracy = Accuracy::homogeneous,
            .surfaces = Surfaces::shared,
            .limitations = cone_limitations,
            .prepare = prepare_cone,
            .append_rows = append_cone_rows,
            .set_quality = set_cone_quality,
            .rungs = cone_rungs,
            .color = "#56B4E9",
            .uses_history = true,
            .interactive = true,
            .resolves_density = false,
            .casts_shadows = false};
}
}
