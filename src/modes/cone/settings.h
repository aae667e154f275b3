// Settings of the analytic light cones.
#pragma once
#include "modes/resolution.h"
#include "modes/settings.h"

namespace tyndall {
struct Rung;

enum class ConeAttenuation { inverse_square, linear, none };
enum class ConeEdge { physical, soft };

struct ConeSettings {
    int nodes = 8;         // Gauss–Legendre nodes on the widest pieces of a ray
    float near_radius = 0; // of the lens of a spot: its light begins where the cone is that wide, metres
    ConeAttenuation attenuation = ConeAttenuation::inverse_square;
    ConeEdge edge = ConeEdge::physical;
    float inner = 0.5f;       // with ConeEdge::soft: share of the outer cone's angle that is evenly lit
    float noise = 0;          // modulates the light, 0..1
    float noise_size = 0.6f;  // metres
    float noise_speed = 0.2f; // metres per second, upwards
    Resolution resolution = Resolution::full;
};

// For its row of the table.
void append_cone_rows(std::vector<SettingRow>& rows);
void set_cone_quality(Settings& settings, Quality quality);
std::vector<Rung> cone_rungs();
}
