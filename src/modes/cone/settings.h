// Settings of cone.
#pragma once
#include "modes/resolution.h"
#include "modes/settings.h"

namespace tyndall {
struct Rung;

enum class ConeAttenuation { inverse_square, linear, none };
enum class ConeEdge { physical, soft };

struct ConeSettings {
    int nodes = 8;         // Gauss–Legendre nodes on the widest segments of a ray
    float near_radius = 0; // radius of a spot's lens, meters: its light starts where the cone is that wide
    ConeAttenuation attenuation = ConeAttenuation::inverse_square;
    ConeEdge edge = ConeEdge::physical;
    float inner = 0.5f;       // with ConeEdge::soft: fraction of the outer cone's angle that is uniformly lit
    float noise = 0;          // amount by which noise modulates the light, 0..1
    float noise_size = 0.6f;  // meters
    float noise_speed = 0.2f; // meters per second, upwards
    Resolution resolution = Resolution::full;
};

// For the mode's row of the table.
void append_cone_rows(std::vector<SettingRow>& rows);
void set_cone_quality(Settings& settings, Quality quality);
std::vector<Rung> cone_rungs();
}
