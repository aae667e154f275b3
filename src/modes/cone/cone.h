// Data of the analytic volume lights, made once per frame.
#pragma once
#include "integrate/lobe_cuts.h"
#include "integrate/ray_batch.h"
#include "modes/cone/settings.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "volume/medium.h"

#include <array>
#include <vector>

namespace tyndall {
struct View;
struct Snapshot;
// Fog in coordinates relative to an anchor: rays near it keep full precision however far away the origin is.
struct AnchoredFog {
    dvec3 anchor{0};
    std::vector<Medium> media; // homogeneous and height fog
    // Planes (xyz·x + w = 0) where density has a kink, or where the ray to the light switches to another exit face of a
    // box.
    std::vector<vec4> kinks;
    bool direct = false; // rays to the light stay in the fog: optical depth is extinction times distance

    float extinction() const; // upper bound, 1/m
};

// A spot's edges by angle: sines and cosines of the half angles at which light ends and within which it is uniform.
struct ConeEdges {
    float cosine = 0, sine = 1, even_cosine = 1, even_sine = 0;
    float versine = 1, scale = 1;    // physical: clamp((versine - (1 - cos φ)) · scale, 0, 1)²
    float angle = 0, soft_scale = 0; // soft: smoothstep of clamp((angle - φ) · soft_scale, 0, 1)
};

// A light, and fog anchored at it (for a sun: at the camera).
struct ConeLight {
    Light light;
    AnchoredFog fog;
    ConeEdges edges;
    float reach = 0;               // meters; 1/r² is capped inside
    float near_plane = 0;          // distance along the axis at which light starts, meters
    float linear_range = infinity; // with ConeAttenuation::linear
    int filter_level = 0;          // mip level of the filter that matches the spacing of nodes
};

struct Cone {
    ConeSettings settings;
    StyleSettings style;
    vec3 eye{0};
    AnchoredFog fog;                     // at the eye
    std::vector<vec3> ambient, emission; // per medium and unit optical depth: scattered ambient light, and emission
    std::vector<Box> grids;              // bounds of grids, which are rendered at their mean density
    std::vector<ConeLight> lights;
    LobeCuts lobe;        // for narrow phase lobes in the light of lamps
    float noise_rise = 0; // meters
    bool casts = false;   // the scene has surfaces, whose shadows are ignored
};

// A light with an IES profile or gobo is split into this many equal angles along a ray, of at least eight nodes each.
// filter_node_angle(): mean spacing of the nodes as seen from the light, radians.
inline constexpr int filter_pieces_of_ray = 12;
float filter_node_angle(const Light& light);

Cone make_cone(const View& view, const Snapshot& snapshot, const Settings& settings);

// Fog light along up to 16 rays. Local lights are integrated by Gauss–Legendre quadrature between all kinks, in the
// angle seen from the light, t + b = s tan θ, in which dt/r² is constant (∫ dt/r² = θ/s); suns, emission and ambient
// light in t.
void cone_packet(const Cone& cone, const RayBatch& batch, std::span<Scatter> results);
}
