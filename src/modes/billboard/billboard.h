// Beam cards: placement where light leaks into the scene, and the quads drawn there.
#pragma once
#include "integrate/ray_batch.h"
#include "modes/billboard/settings.h"
#include "modes/settings.h"
#include "scene/camera.h"
#include "trace/snapshot.h"

#include <string>
#include <vector>

namespace tyndall {
struct View;
struct Snapshot;
struct Settings;
// A beam with an elliptical cross-section whose size varies linearly along it.
struct BeamCard {
    std::string name;
    int light = 0; // of the snapshot
    vec3 from{0}, to{0};
    vec3 across[2]{};              // unit: axes of the cross-section
    vec2 half_from{0}, half_to{0}; // half widths along these axes, meters
    vec3 tint{1};
    uint32_t seed = 0;
};

// Cards for the openings that lights shine through, and hand-placed ones. Independent of the camera.
// A grid of rays is traced from each light. Cells whose ray crosses enough fog before the first surface are lit, and
// connected lit cells form an opening. Large openings are split (k-means); an unobstructed spot gets one card. For a
// sun in the open, the gaps between neighboring surfaces are the openings; `open`: per light, the lit fraction of such
// a sun's grid, else 0.
std::vector<BeamCard> place_cards(const Snapshot& snapshot, const BillboardSettings& settings,
                                  std::vector<float>* open = nullptr);

// Distance of a point from the beam's axis, in half widths of the beam there; infinite beyond the beam's ends.
float off_axis(const BeamCard& card, vec3 point);

// A card's quad for the current camera.
struct CardQuad {
    int card = 0, light = 0;
    vec3 start{0}, normal{0}, along{0}, side{0}; // orthonormal; the beam runs from `start` along `along`
    float length = 0;                            // of the quad
    float half_from = 0, half_to = 0;            // half widths of the quad at its ends
    vec3 axis{0};                                // of the beam
    vec3 across[2]{};
    vec2 width_from{0}, width_to{0}; // of the beam: the card's half_from and half_to
    vec3 tint{1};
    float share = 1; // factor on brightness: sway, and fade when the eye is inside
    float seed = 0;
    bool crossed = false; // one of two fixed, crossed quads
};

// Bounds of 16 quads, to cull those that no ray of a packet can hit. A ray is represented by the (right, up, forward)
// components of its direction or, with an orthographic camera, by (right, up, 1) of its origin.
struct CardGroup {
    float edges[4][3][16] = {}; // edge planes: dot products with rays that hit the quad are not negative
    float nearest[16];          // planar depth of the nearest corner
};

struct Billboards {
    BillboardSettings settings;
    StyleSettings style;
    Snapshot snapshot; // stylized, with homogeneous fog
    std::vector<CardQuad> quads;
    std::vector<CardGroup> groups; // of the quads
    std::vector<float> veils;      // per light: factor on the unshadowed haze of a sun in the open
    Camera camera;
    float pixel = 0; // meters: width of a pixel, at a distance of 1 m in perspective
    float seconds = 0;
};

Billboards make_billboards(const View& view, const Snapshot& snapshot, const Settings& settings);

void billboard_packet(const Billboards& billboards, const RayBatch& batch, std::span<Scatter> results);
}
