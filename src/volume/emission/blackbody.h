// Light of a blackbody: Planck's law seen by the CIE 1931 standard observer, as linear Rec.709.
#pragma once
#include "base/math.h"

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace tyndall {
// How programs turn a temperature into what fog emits.
enum class BlackbodyKind { kelvin, cycles, pbrt };
inline constexpr std::string_view blackbody_names[] = {"kelvin", "cycles", "pbrt"};

// Spectral radiance, W/(m² sr m), of a wavelength in metres.
double planck_radiance(double wavelength, double kelvin);

// XYZ of a blackbody's radiance: Y is its luminance in nits (683 lm/W).
dvec3 blackbody_xyz(double kelvin);

// Linear Rec.709 (D65) of XYZ, channels below 0 included.
dvec3 rec709_from_xyz(dvec3 xyz);

// The nearest color without negative channels on the line to grey of the same luminance.
dvec3 in_gamut(dvec3 rgb);

// Linear Rec.709 of luminance 1, in gamut; black where so little is visible that no number holds it.
dvec3 blackbody_tint(double kelvin);

// What stands for a temperature before any scale, linear Rec.709, in gamut but where said otherwise:
//   kelvin: radiance, nits.
//   cycles: 5.670373e-8 · 1e-6 / π · (1 - intensity + intensity T⁴) × the color at luminance 1, with what is below 0
//           cut off (Blender's Principled Volume, kernel/svm/closure.h): brighter by up to 1 % from 1200 K on.
//   pbrt: Planck's law over its own maximum, summed over the observer's curves as pbrt's film does it: an even spectrum
//         of 1 is 106.9 nits, as only its lights are scaled to nits (pbrt-v4 media.h, film.h, lights.cpp); 0 at or
//         below 100 K.
dvec3 blackbody_color(BlackbodyKind kind, double kelvin, double intensity = 1);

// Below this some channel was negative: redder than Rec.709 can be, kelvin.
double lowest_in_gamut();

// blackbody_color() of every temperature that a grid can hold, in steps of less than .2 % of it, straight between:
// within 0.1 % from 500 K on. Below 256 K, where nothing is to be seen, 0.
//
//   entry i : temperature whose float has the bits (first + i) << 14, so that 512 entries make an octave
class BlackbodyTable {
public:
    static constexpr float lowest = 256, highest = 65536;
    static constexpr int shift = 14;
    static constexpr int32_t first = 0x43800000 >> shift; // of 256
    static constexpr int32_t entries = 8 * 512;

    explicit BlackbodyTable(BlackbodyKind kind, double intensity);
    vec3 at(float kelvin) const;
    const float* channel(int c) const { return values_[c].data(); } // entries + 2 floats

private:
    std::vector<float> values_[3];
};

// The table of a kind, made once. From any thread.
std::shared_ptr<const BlackbodyTable> blackbody_table(BlackbodyKind kind, float intensity = 1);
}
