// Settings of billboard.
#pragma once
#include "modes/settings.h"

namespace tyndall {
struct Rung;

enum class CardFacing { axis, camera, cross };

struct BillboardSettings {
    int cards = 64; // maximum per light, largest openings first
    CardFacing facing = CardFacing::axis;
    float brightness = 1;    // factor on all cards and veils
    float veil = 0.5f;       // fraction of a sun's unshadowed fog light that is added as haze in the open
    float gaps = 4;          // factor on cards in the open, so that they show against the veil
    float streaks = 0.55f;   // how far stripes along the beam darken it, 0..1
    float stripes = 14;      // stripes across a card
    float soft = 1;          // fraction of a card's half width that fades out
    float scroll = 0.05f;    // speed of the texture along the beam, meters per second
    float sway = 0.15f;      // how far the brightness swings, 0..1
    float specks = 0.25f;    // brightness of dust particles in the beam
    float near_fade = 0.6f;  // meters from the eye within which a card fades in
    float far_fade = 1e9f;   // meters from the eye at which it has faded out
    float soft_depth = 0.4f; // meters in front of a surface over which a card fades out
    bool fog = true;         // homogeneous fog attenuates cards and what is behind them
};

// For the mode's row of the table.
void append_billboard_rows(std::vector<SettingRow>& rows);
std::vector<Rung> billboard_rungs();
}
