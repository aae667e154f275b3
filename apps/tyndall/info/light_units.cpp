#include "light_units.h"
#include "base/text.h"

#include <cstdlib>
#include <numbers>

namespace tyndall {
namespace {
constexpr double lumens_per_watt = 683, sphere = 4 * std::numbers::pi;

// Whether a person could have typed the number: at most three significant digits.
bool typed(double value) {
    return std::abs(std::strtod(formatted("%.2e", value).c_str(), nullptr) - value) <= 2e-6 * value;
}

// The number a Blender user would have typed for a light, by kind of export.
double spec_value(const LightSource& light, double intensity) {
    return is_distant(light) ? intensity / lumens_per_watt : intensity / lumens_per_watt * sphere;
}
double unitless_value(const LightSource& light, double intensity) {
    return is_distant(light) ? intensity : intensity * sphere;
}

// 0 for a light whose unit is known: one from the scene file, or one with an explicit unit.
double exported(const LightSource& light) {
    return light.node < 0 || light.unit != LightUnit::native ? 0 : light.intensity.at(0);
}

bool all_typed(const Scene& scene, double (*value)(const LightSource&, double)) {
    for (const LightSource& light : scene.lights) {
        const double intensity = exported(light);
        if (intensity > 0 && !typed(value(light, intensity))) return false;
    }
    return true;
}
}

std::string light_units_hint(const Scene& scene) {
    bool any_local = false, any = false, all_large = true;
    for (const LightSource& light : scene.lights) {
        const double intensity = exported(light);
        if (!(intensity > 0)) continue;
        any = true;
        any_local |= !is_distant(light);
        if (!is_distant(light)) all_large &= intensity >= 100;
    }
    if (!any) return "";
    if (all_typed(scene, spec_value))
        return "intensities look like Blender's standard export: candela and lux, as they should be";
    if (!any_local) return "";
    if (all_typed(scene, unitless_value))
        return "intensities look like Blender's unitless export: render with --light-units unitless";
    if (all_large && all_typed(scene, [](const LightSource&, double intensity) { return intensity; }))
        return "intensities are round and large: candela, or watts of Blender's raw export (then --light-units raw)";
    return "";
}
}
