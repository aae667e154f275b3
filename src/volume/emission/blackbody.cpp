#include "volume/emission/blackbody.h"

#include "volume/emission/cie_1931.h"

#include <bit>
#include <map>
#include <mutex>
#include <numbers>

namespace tyndall {
namespace {
// CODATA 2018, exact.
constexpr double planck_constant = 6.62607015e-34, light_speed = 299792458, boltzmann_constant = 1.380649e-23;
constexpr double lumens_per_watt = 683;
constexpr double wien = 2.897771955e-3; // m K: peak wavelength × temperature

// ∫ of a spectrum times the CIE matching functions over wavelengths in nanometers.
template<class Spectrum> dvec3 observed(const Spectrum& spectrum) {
    dvec3 sum(0);
    for (size_t i = 0; i < std::size(cie_1931); ++i)
        sum += spectrum((first_nm + static_cast<double>(i) * step_nm) * 1e-9) *
               dvec3(cie_1931[i][0], cie_1931[i][1], cie_1931[i][2]);
    return sum * step_nm;
}

// XYZ of Planck's law normalized to its maximum, which keeps values in range at any temperature.
dvec3 relative_xyz(double kelvin) {
    const double highest = planck_radiance(wien / kelvin, kelvin);
    return observed([&](double wavelength) { return planck_radiance(wavelength, kelvin) / highest; });
}
}

double planck_radiance(double wavelength, double kelvin) {
    const double x = planck_constant * light_speed / (wavelength * boltzmann_constant * kelvin);
    const double squared = wavelength * wavelength;
    return 2 * planck_constant * light_speed * light_speed / (squared * squared * wavelength * std::expm1(x));
}

dvec3 blackbody_xyz(double kelvin) {
    return 1e-9 * lumens_per_watt * observed([&](double wavelength) { return planck_radiance(wavelength, kelvin); });
}

dvec3 rec709_from_xyz(dvec3 xyz) {
    return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
            -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
            0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

dvec3 in_gamut(dvec3 rgb) {
    const double gray = luminance(rgb);
    const double least = std::min({rgb.x, rgb.y, rgb.z});
    if (least >= 0 || !(gray > 0)) return glm::max(rgb, dvec3(0));
    return glm::max(gray + (rgb - gray) * (gray / (gray - least)), dvec3(0));
}

dvec3 blackbody_color(BlackbodyKind kind, double kelvin, double intensity) {
    if (!(kelvin > 0) || (kind == BlackbodyKind::pbrt && kelvin <= 100)) return dvec3(0);
    if (kind == BlackbodyKind::kelvin) return in_gamut(rec709_from_xyz(blackbody_xyz(kelvin)));
    if (kind == BlackbodyKind::pbrt) return in_gamut(rec709_from_xyz(relative_xyz(kelvin)));
    const dvec3 xyz = relative_xyz(kelvin);
    if (!(xyz.y > 0)) return dvec3(0);
    constexpr double stefan_boltzmann = 5.670373e-8 * 1e-6 * std::numbers::inv_pi;
    const double power = 1 + (kelvin * kelvin * kelvin * kelvin - 1) * intensity;
    return glm::max(rec709_from_xyz(xyz / xyz.y), dvec3(0)) * (stefan_boltzmann * power);
}

dvec3 blackbody_tint(double kelvin) {
    const dvec3 xyz = relative_xyz(kelvin);
    if (!(xyz.y > 0)) return dvec3(0);
    const dvec3 rgb = in_gamut(rec709_from_xyz(xyz / xyz.y));
    return rgb / luminance(rgb);
}

double lowest_in_gamut() {
    static const double kelvin = [] {
        double low = 1000, high = 4000;
        for (int i = 0; i < 40; ++i) {
            const double middle = 0.5 * (low + high);
            const dvec3 rgb = rec709_from_xyz(blackbody_xyz(middle));
            (std::min({rgb.x, rgb.y, rgb.z}) < 0 ? low : high) = middle;
        }
        return high;
    }();
    return kelvin;
}

BlackbodyTable::BlackbodyTable(BlackbodyKind kind, double intensity) {
    for (std::vector<float>& channel : values_) channel.assign(entries + 2, 0.0f);
    for (int32_t i = 1; i <= entries; ++i) {
        const dvec3 rgb = blackbody_color(kind, std::bit_cast<float>((first + i) << shift), intensity);
        for (int c = 0; c < 3; ++c) values_[c][static_cast<size_t>(i)] = static_cast<float>(rgb[c]);
    }
    for (std::vector<float>& channel : values_) channel[entries + 1] = channel[entries];
}

vec3 BlackbodyTable::at(float kelvin) const {
    if (!(kelvin > lowest)) return vec3(0);
    const auto bits = std::bit_cast<int32_t>(std::min(kelvin, highest));
    const auto i = static_cast<size_t>((bits >> shift) - first);
    const float share = static_cast<float>(bits & ((1 << shift) - 1)) * (1.0f / (1 << shift));
    vec3 rgb;
    for (int c = 0; c < 3; ++c) rgb[c] = std::fma(values_[c][i + 1] - values_[c][i], share, values_[c][i]);
    return rgb;
}

std::shared_ptr<const BlackbodyTable> blackbody_table(BlackbodyKind kind, float intensity) {
    static std::mutex mutex;
    static std::map<std::pair<BlackbodyKind, float>, std::shared_ptr<const BlackbodyTable>> tables;
    const std::scoped_lock lock(mutex);
    std::shared_ptr<const BlackbodyTable>& table = tables[{kind, intensity}];
    if (!table) table = std::make_shared<const BlackbodyTable>(kind, intensity);
    return table;
}
}
