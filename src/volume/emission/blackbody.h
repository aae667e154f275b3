// Blackbody emission: Planck's law weighted by the CIE 1931 standard observer, as linear Rec.709.
#pragma once
#include "base/math.h"

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace tyndall {
// Conventions of different programs for turning temperature into emission.
enum class BlackbodyKind { kelvin, cycles, pbrt };
inline constexpr std::string_view blackbody_names[] = {"kelvin", "cycles", "pbrt"};

// Spectral radiance, W/(m² sr m), at a wavelength in meters.
double planck_radiance(double wavelength, double kelvin);

// XYZ of a blackbody's radiance: Y is its luminance in nits (683 lm/W).
dvec3 blackbody_xyz(double kelvin);

// Linear Rec.709 (D65) from XYZ; negative channels are kept.
dvec3 rec709_from_xyz(dvec3 xyz);

// Desaturates toward gray of the same luminance until no channel is negative.
dvec3 in_gamut(dvec3 rgb);

// Linear Rec.709 of luminance 1, in gamut; black if the visible radiance underflows.
dvec3 blackbody_tint(double kelvin);

// Emission at a temperature before any scale, linear Rec.709, gamut-mapped by in_gamut() unless noted:
// kelvin: radiance, nits.
// cycles: 5.670373e-8 · 1e-6 / π · (1 - intensity + intensity T⁴) × the color at luminance 1, with negative channels
// clamped to 0 (Blender's Principled Volume, kernel/svm/closure.h): brighter by up to 1 % above 1200 K.
// pbrt: Planck's law normalized to its maximum and integrated as by pbrt's film: a constant spectrum of 1 is
// 106.9 nits, because pbrt scales only its lights to nits (pbrt-v4 media.h, film.h, lights.cpp); 0 at or
// below 100 K.
dvec3 blackbody_color(BlackbodyKind kind, double kelvin, double intensity = 1);

// The temperature, kelvin, below which a blackbody is outside the Rec.709 gamut (too red).
double lowest_in_gamut();

// blackbody_color() tabulated in temperature steps of less than 0.2 % and interpolated linearly: error within 0.1 %
// above 500 K. 0 below 256 K, where nothing is visible.
//
// entry i : temperature whose float has the bits (first + i) << 14, which gives 512 entries per octave
class BlackbodyTable {
public:
    static constexpr float lowest = 256, highest = 65536;
    static constexpr int shift = 14;
    static constexpr int32_t first = 0x43800000 >> shift; // bits of 256
    static constexpr int32_t entries = 8 * 512;

    explicit BlackbodyTable(BlackbodyKind kind, double intensity);
    vec3 at(float kelvin) const;
    const float* channel(int c) const { return values_[c].data(); } // entries + 2 floats

private:
    std::vector<float> values_[3];
};

// The cached table for a kind and intensity. Thread-safe.
std::shared_ptr<const BlackbodyTable> blackbody_table(BlackbodyKind kind, float intensity = 1);
}
