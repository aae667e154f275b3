// What the analytic light cones need, made once per frame.
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
// Even fog in coordinates that count from a point: rays near it keep all their digits however far the origin is.
struct AnchoredFog {
    dvec3 anchor{0};
    std::vector<Medium> media; // homogeneous and height fog
    // Planes (xyz·x + w = 0) where density has a kink, or the way to the light changes the face it leaves a box by.
    std::vector<vec4> kinks;
    bool direct = false; // from everywhere in the fog the way to the light lies in the fog: its length is its depth

    float extinction() const; // the most there can be, 1/m
};

// A spot's edges by angle: sines and cosines of the half angles where light ends and from where on it is even.
struct ConeEdges {
    float cosine = 0, sine = 1, even_cosine = 1, even_sine = 0;
    float versine = 1, scale = 1;    // physical: clamp((versine - (1 - cos φ)) · scale, 0, 1)²
    float angle = 0, soft_scale = 0; // soft: smoothstep of clamp((angle - φ) · soft_scale, 0, 1)
};

// A light in fog anchored at it (a sun: at the camera).
struct ConeLight {
    Light light;
    AnchoredFog fog;
    ConeEdges edges;
    float reach = 0;               // metres: 1/r² is capped inside
    float near_plane = 0;          // along the axis
    float linear_range = infinity; // with ConeAttenuation::linear
    int filter_level = 0;          // of a gobo: as blurred as nodes are apart
};

struct Cone {
    ConeSettings settings;
    StyleSettings style;
    vec3 eye{0};
    AnchoredFog fog;                     // at the eye
    std::vector<vec3> ambient, emission; // per medium: ambient light scattered, and light given off, per optical depth
    std::vector<Box> grids;              // bounds of media that are drawn evener than they are
    std::vector<ConeLight> lights;
    LobeCuts lobe;        // of the fog in the light of lamps
    float noise_rise = 0; // metres so far
    bool casts = false;   // there are surfaces to cast the shadows that are not drawn
};

// Of an IES profile or gobo each of so many pieces of what a ray sees of the light has some eight nodes.
inline constexpr int filter_pieces_of_ray = 12;
float filter_node_angle(const Light& light);

Cone make_cone(const View& view, const Snapshot& snapshot, const Settings& settings);

// Fog light along up to 16 rays. Local lights are integrated in the angle seen from the light, t + b = s tan θ, in
// which 1/r² dt is even (∫ dt/r² = θ/s), by Gauss–Legendre between all kinks; suns, emission and ambient light along t.
void cone_packet(const Cone& cone, const RayBatch& batch, std::span<Scatter> results);
}
