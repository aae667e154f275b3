// Where the exact march places its nodes. Internal to it.
#pragma once
#include "base/gauss_legendre.h"
#include "integrate/style.h"
#include "modes/march/lit_nodes.h"
#include "volume/medium.h"
#include "volume/rays/fog_pieces.h"

namespace tyndall {
inline constexpr int nodes_per_step = 2;
inline constexpr int nodes_across_cone = 4; // exact for a soft edge squared, a polynomial of degree 4 along the ray

// A segment that sees a fraction of a light's sample points.
struct LitPart {
    Interval<double> stretch;
    double share = 1;
};

// Where the number of visible sample points changes.
struct LitEnd {
    double t = 0;
    int change = 0;
};

// Memory that a thread reuses from ray to ray.
struct MarchScratch {
    FogPieces fog;
    LightAlong along;
    std::vector<LitPart> lit; // by the current light
    std::vector<LitEnd> ends;
    std::vector<LitNode> nodes; // to resample from
};

// One ray and what its march has found so far.
struct RayMarch {
    const SingleScattering& frame;
    const Ray& ray;
    float jitter = 0.5f; // in [0,1)
    MarchScratch& scratch;
    double longest = 0; // maximum length of a step
    double detail = 0;  // finest detail of the light's filter, radians; 0 = no filter
    int nodes = 0;

    dvec3 at(double t) const { return dvec3(ray.origin) + t * dvec3(ray.direction); }
};

// Splits a segment of one piece of fog until every step is within the march's step limits; `along`: the current light,
// or null.
template<class Visit>
void split(const RayMarch& on, size_t piece, double low, double high, const LightAlong* along, const Visit& visit) {
    const MarchSettings& settings = on.frame.rule->settings;
    const FogPieces& fog = on.scratch.fog;
    const double closest = 1e-4 * on.frame.snapshot.extent; // closer to a light, steps get no shorter
    const double length = high - low;
    const double away = along ? std::max(along->distance_to(low, high), closest) : double(infinity);
    if (length > away && length > settings.near_light * away) {
        split(on, piece, low, 0.5 * (low + high), along, visit);
        return split(on, piece, 0.5 * (low + high), high, along, visit);
    }
    const double depth = fog.depth_at(piece, high) - fog.depth_at(piece, low);
    const double voxels = std::max(fog.pieces[piece].voxels, along ? along->shadow_voxels(low, high) : 0.0);
    const double wanted = std::max({depth / settings.step_depth, length * voxels / settings.step_voxels,
                                    length / on.longest, length / (settings.near_light * away)});
    double steps = std::max(1.0, std::ceil(wanted * (1 - 1e-6)));
    if (along && on.detail > 0) {
        const EquiAngular<double> seen_from_light = along->angles(low, high);
        steps = std::max(steps, std::ceil((seen_from_light.to - seen_from_light.from) / on.detail));
    }
    for (double i = 0; i < steps; ++i) visit(low + length * (i / steps), low + length * ((i + 1) / steps));
}

// Fraction of the light scattered at a point of the ray that reaches the eye.
inline double seen(const RayMarch& on, size_t piece, double t) {
    const StyleSettings& style = on.frame.style;
    const double share = std::exp(-style.view_depth * on.scratch.fog.depth_at(piece, t));
    if (style.range >= StyleSettings{}.range) return share;
    return share * style_fade(style, eye_distance(on.frame.camera, on.ray.at(static_cast<float>(t))));
}

// Calls body(piece, t, weight) at the nodes of all fog on the ray; weights include transmittance to the eye.
template<class Body> void at_nodes(RayMarch& on, const Body& body) {
    const FogPieces& fog = on.scratch.fog;
    for (size_t piece = 0; piece < fog.pieces.size(); ++piece)
        split(on, piece, fog.pieces[piece].low, fog.pieces[piece].high, nullptr, [&](double low, double high) {
            for (const QuadratureNode& node : gauss_legendre(nodes_per_step)) {
                const double t = low + (high - low) * node.at;
                body(piece, t, (high - low) * node.weight * seen(on, piece, t));
                ++on.nodes;
            }
        });
}

// The albedo of a medium at a point of the ray.
inline vec3 albedo_on(const RayMarch& on, const Optics& optics, double t) {
    return optics.albedo_field ? albedo_at(optics, vec3(on.at(t))) : optics.albedo;
}

// Whether a step is one of less than four of a stretch of a cone's light: the soft edge then changes too much for
// nodes_per_step.
inline bool crosses_cone(const LightAlong& along, Interval<double> stretch, double low, double high) {
    return has_cone(*along.light) && high - low > 0.3 * stretch.length();
}

// Quadrature nodes of one step: in t for suns, in the angle seen from the light for local lights.
template<class Add>
void visit_nodes(const LightAlong& along, std::span<const QuadratureNode> nodes, double low, double high,
                 const Add& add) {
    if (!along.local()) {
        for (const QuadratureNode& node : nodes) add(low + (high - low) * node.at, (high - low) * node.weight);
        return;
    }
    const EquiAngular<double> angles = along.angles(low, high);
    for (const QuadratureNode& node : nodes) {
        const auto [t, length] = angles.at(node.at);
        add(t, length * node.weight);
    }
}

// split(), at narrow phase lobes as well.
template<class Visit>
void split_at_lobes(const RayMarch& on, size_t piece, double low, double high, const LightAlong& along,
                    const Visit& visit) {
    const LobeCuts& lobe = on.frame.lobe;
    for (int i = 0; i < lobe.count && along.local(); ++i) {
        const double cut = along.nearest + along.distance * double{lobe.slopes[i]};
        if (!(cut > low && cut < high)) continue;
        split(on, piece, low, cut, &along, visit);
        low = cut;
    }
    split(on, piece, low, high, &along, visit);
}
}
