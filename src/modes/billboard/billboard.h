// Beam cards: where light leaks into the scene, and what is drawn there.
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
// A beam with an elliptic cross-section that widens evenly from one end to the other.
struct BeamCard {
    std::string name;
    int light = 0; // of the snapshot
    vec3 from{0}, to{0};
    vec3 across[2]{};              // unit: axes of the cross-section
    vec2 half_from{0}, half_to{0}; // its half widths along them, metres
    vec3 tint{1};
    uint32_t seed = 0;
};

// Cards for the openings that lights shine through, and those placed by hand. Does not depend on the camera.
// Seen from each light: cells of a grid of rays that get past the occluders next to the light are lit, and
// connected lit cells are an opening. Those that fill much of the grid are cut up (k-means); a free spot has one card.
// Under an open sun the gaps between neighbouring surfaces are the openings; `open`: per light, the lit share of such a
// sun's grid.
std::vector<BeamCard> place_cards(const Snapshot& snapshot, const BillboardSettings& settings,
                                  std::vector<float>* open = nullptr);

// How far a point is from the beam's axis, in half widths of the beam there; infinite before and behind it.
float off_axis(const BeamCard& card, vec3 point);

// A card as this camera sees it.
struct CardQuad {
    int card = 0, light = 0;
    vec3 start{0}, normal{0}, along{0}, side{0}; // orthonormal; the beam runs from `start` along `along`
    float length = 0;                            // on the plane
    float half_from = 0, half_to = 0;            // across
    vec3 axis{0};                                // of the beam
    vec3 across[2]{};
    vec2 width_from{0}, width_to{0}; // of the beam, as half_from and half_to of the card
    vec3 tint{1};
    float share = 1; // of the beam's brightness: sway, an eye inside
    float seed = 0;
    bool crossed = false; // one of two that stand still
};

// Sixteen quads side by side, to leave out those that a packet of rays cannot meet. A ray is (right, up, forward) of
// its direction, or (right, up, 1) of its place in an orthographic picture.
struct CardGroup {
    float edges[4][3][16] = {}; // products with rays that meet the quad are not negative
    float nearest[16];          // planar depth of the nearest corner
};

struct Billboards {
    BillboardSettings settings;
    StyleSettings style;
    Snapshot snapshot; // stylised, fog made even
    std::vector<CardQuad> quads;
    std::vector<CardGroup> groups; // of the quads
    std::vector<float> veils;      // per light: share of the unshadowed light that an open sun leaves in all fog
    Camera camera;
    float pixel = 0; // width of a pixel one metre away
    float seconds = 0;
};

Billboards make_billboards(const View& view, const Snapshot& snapshot, const Settings& settings);

void billboard_packet(const Billboards& billboards, const RayBatch& batch, std::span<Scatter> results);
}
