#include "scene/photometry/light_power.h"

#include "scene/light.h"
#include "scene/photometry/ies_profile.h"
#include "scene/scene.h"
#include "volume/emission/blackbody.h"

namespace tyndall {
namespace {
// Candela per lumen of a light.
double candela_per_lumen(const LightSource& light, double seconds) {
    constexpr double sphere = 4 * double{pi};
    if (light.profile) return light.profile->peak / light.profile->lumens;
    if (light.kind != LightKind::sphere && has_area(light)) return 1 / (double{pi} * (light.two_sided ? 2 : 1));
    if (!has_cone(light) || light.whole_sphere) return 1 / sphere;
    const double outer = light.outer_cone.at(seconds);
    const double lumens = cone_lumens(std::min<double>(light.inner_cone.at(seconds), outer), outer);
    return lumens > 0 ? 1 / lumens : 0; // no cone, no light
}
}

double cone_lumens(double inner, double outer) {
    // As in cone_falloff(): ((cosine - edge) / width)² up to the uniform part.
    const double whole = 2 * std::sin(0.5 * outer) * std::sin(0.5 * outer); // 1 - cos(outer)
    const double width = std::max(std::cos(inner) - std::cos(outer), min_cone_edge(outer));
    const double even = std::max(whole - width, 0.0), soft = std::min(whole, width);
    return 2 * double{pi} * (even + soft * soft * soft / (3 * width * width));
}

double face_area(const LightSource& light, double seconds) {
    if (light.kind == LightKind::rectangle) return double{light.width.at(seconds)} * light.height.at(seconds);
    const double radius = light.radius.at(seconds);
    return double{pi} * radius * radius;
}

float candela_of(const LightSource& light, double seconds) {
    float value = light.intensity.at(seconds);
    if (has_area(light) && light.unit == LightUnit::native) value *= static_cast<float>(face_area(light, seconds));
    if (light.unit == LightUnit::profile) value *= static_cast<float>(light.profile->peak);
    if (light.unit == LightUnit::watt) value *= light.efficacy;
    if ((light.unit == LightUnit::lumen || light.unit == LightUnit::watt) && !is_distant(light))
        value *= static_cast<float>(candela_per_lumen(light, seconds));
    const float stops = light.exposure.at(seconds);
    return stops == 0 ? value : value * std::exp2(stops);
}

float native_intensity(const LightSource& light, double seconds) {
    const float candela = candela_of(light, seconds);
    return has_area(light) ? static_cast<float>(candela / face_area(light, seconds)) : candela;
}

vec3 intensity_of(const LightSource& light, double seconds) {
    vec3 color = light.color.at(seconds);
    if (const float kelvin = light.temperature.at(seconds); kelvin > 0) color *= vec3(blackbody_tint(kelvin));
    return color * candela_of(light, seconds);
}
}
