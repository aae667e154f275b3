#include "volume/recipe/recipe.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/recipe/density.cpp"
#include <hwy/foreach_target.h>

#include "volume/recipe/fire_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Calls values_at() for sixteen points at a time, relative to the field's origin.
template<class ValuesAt>
void for_points(const FogField& field, size_t count, const float* x, const float* y, const float* z, float* results,
                const ValuesAt& values_at) {
    const dvec3 middle = field.origin;
    for (size_t first = 0; first < count; first += 16) {
        const size_t some = std::min<size_t>(16, count - first);
        float local[3][16] = {}, values[16];
        for (size_t i = 0; i < some; ++i) {
            local[0][i] = static_cast<float>(x[first + i] - middle.x);
            local[1][i] = static_cast<float>(y[first + i] - middle.y);
            local[2][i] = static_cast<float>(z[first + i] - middle.z);
        }
        store(values_at(Vec3s{load(local[0]), load(local[1]), load(local[2])}), values);
        std::memcpy(results + first, values, some * sizeof(float));
    }
}

void recipe_density_kernel(const FogField& field, size_t count, const float* x, const float* y, const float* z,
                           float* density) {
    int finished = 0;
    if (field.fire.burns)
        for_points(field, count, x, y, z, density,
                   [&](const Vec3s& p) { return fire_fog(field, p, finished).density; });
    else
        for_points(field, count, x, y, z, density, [&](const Vec3s& p) { return fog_density(field, p, finished); });
}

void recipe_temperature_kernel(const FogField& field, size_t count, const float* x, const float* y, const float* z,
                               float* kelvin) {
    int finished = 0;
    for_points(field, count, x, y, z, kelvin, [&](const Vec3s& p) { return fire_fog(field, p, finished).kelvin; });
}

void recipe_swirl_kernel(const FogField& field, std::span<const vec3> points, std::span<vec3> displacements) {
    for (size_t first = 0; first < points.size(); first += 16) {
        const size_t some = std::min<size_t>(16, points.size() - first);
        float local[3][16] = {}, moved[3][16];
        for (size_t i = 0; i < some; ++i)
            for (int axis = 0; axis < 3; ++axis)
                local[axis][i] = static_cast<float>(points[first + i][axis] - field.origin[axis]);
        const Vec3s d = displacement(field, {load(local[0]), load(local[1]), load(local[2])});
        store(d.x, moved[0]), store(d.y, moved[1]), store(d.z, moved[2]);
        for (size_t i = 0; i < some; ++i) displacements[first + i] = {moved[0][i], moved[1][i], moved[2][i]};
    }
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(recipe_density_kernel);
HWY_EXPORT(recipe_temperature_kernel);
HWY_EXPORT(recipe_swirl_kernel);

void recipe_swirl(const FogRecipe& recipe, double seconds, std::span<const vec3> points,
                  std::span<vec3> displacements) {
    assert(points.size() == displacements.size());
    HWY_DYNAMIC_DISPATCH(recipe_swirl_kernel)(fog_field(recipe, seconds), points, displacements);
}

void recipe_density(const FogRecipe& recipe, double seconds, std::span<const float> x, std::span<const float> y,
                    std::span<const float> z, std::span<float> density) {
    assert(x.size() == density.size() && y.size() == density.size() && z.size() == density.size());
    const FogField field = fog_field(recipe, seconds);
    HWY_DYNAMIC_DISPATCH(recipe_density_kernel)(field, density.size(), x.data(), y.data(), z.data(), density.data());
}

void recipe_temperature(const FogRecipe& recipe, double seconds, std::span<const float> x, std::span<const float> y,
                        std::span<const float> z, std::span<float> kelvin) {
    assert(x.size() == kelvin.size() && y.size() == kelvin.size() && z.size() == kelvin.size());
    const FogField field = fog_field(recipe, seconds);
    if (!field.fire.burns)
        std::ranges::fill(kelvin, 0.0f);
    else
        HWY_DYNAMIC_DISPATCH(recipe_temperature_kernel)
    (field, kelvin.size(), x.data(), y.data(), z.data(), kelvin.data());
}
}
#endif
