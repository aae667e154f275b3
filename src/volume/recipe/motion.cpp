#include "volume/recipe/motion.h"

#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/recipe/motion.cpp"
#include <hwy/foreach_target.h>

#include "volume/recipe/fire_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
HWY_INLINE Vec3s cross(const Vec3s& a, const Vec3s& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Displacement by the swirl; in flames scaled by fire_onset().
HWY_INLINE Vec3s swirl_reaching(const FogField& field, const Vec3s& p, const Mask16& flame) {
    const Vec3s moved = displacement(field, p);
    if (!any(flame)) return moved;
    return moved * select(flame, fire_onset(field.fire, p.y), 1.0f);
}

// The noise coordinate p + D(p, t) moves with the advection, so p itself moves at (1 + ∇D)⁻¹ (advection - ∂D/∂t).
HWY_INLINE Vec3s velocity_of(const FogMotion& motion, const Vec3s& p, const Mask16& flame) {
    const auto advection = [&](int axis) { return select(flame, motion.rise[axis], motion.wind[axis]); };
    const Vec3s advected{advection(0), advection(1), advection(2)};
    if (motion.now.swirl_gain == 0) return advected;

    // Derivatives by central differences with a step of a hundredth of a cell.
    const float reach = 0.01f / motion.now.swirl.frequency;
    const auto slope = [&](vec3 axis) {
        const Vec3s high = p + splat(axis * reach), low = p - splat(axis * reach);
        const Vec3s rise = swirl_reaching(motion.now, high, flame) - swirl_reaching(motion.now, low, flame);
        return fma(rise, 0.5f / reach, splat(axis));
    };
    const Vec3s x = slope({1, 0, 0}), y = slope({0, 1, 0}), z = slope({0, 0, 1});
    const Vec3s drift =
        (swirl_reaching(motion.after, p, flame) - swirl_reaching(motion.before, p, flame)) * (0.5f / motion.step);

    // Cramer's rule. Where the swirl folds space, no velocity is correct; omit the inverse so that it stays finite.
    const Vec3s right = advected - drift;
    const Floats volume = dot(x, cross(y, z));
    const Mask16 clean = volume > 0.2f;
    const Floats by = 1.0f / max(volume, 0.2f);
    return {select(clean, dot(right, cross(y, z)) * by, right.x), select(clean, dot(right, cross(z, x)) * by, right.y),
            select(clean, dot(right, cross(x, y)) * by, right.z)};
}

void fog_velocity_kernel(const FogMotion& motion, std::span<const vec3> points, std::span<const float> kelvin,
                         std::span<vec3> velocity) {
    const FireField& fire = motion.now.fire;
    for (size_t first = 0; first < points.size(); first += 16) {
        const size_t some = std::min<size_t>(16, points.size() - first);
        float at[3][16] = {}, found[3][16], hot[16] = {};
        for (size_t i = 0; i < some; ++i) {
            hot[i] = kelvin[first + i];
            for (int axis = 0; axis < 3; ++axis) at[axis][i] = points[first + i][axis];
        }
        const Mask16 flame = load(hot) >= (fire.burns ? fire.edge : infinity);
        const Vec3s v = velocity_of(motion, {load(at[0]), load(at[1]), load(at[2])}, flame);
        store(v.x, found[0]), store(v.y, found[1]), store(v.z, found[2]);
        for (size_t i = 0; i < some; ++i) velocity[first + i] = {found[0][i], found[1][i], found[2][i]};
    }
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(fog_velocity_kernel);

// The time step is a hundredth of a turn of the swirl, but at most a hundredth of a second.
FogMotion fog_motion(const FogRecipe& recipe, double seconds) {
    const double speed =
        recipe.period > 0 ? turns_per_loop(recipe, recipe.swirl_speed) / recipe.period : double{recipe.swirl_speed};
    const double step = 0.01 / std::max(1.0, speed);
    return {fog_field(recipe, seconds),
            fog_field(recipe, seconds - step),
            fog_field(recipe, seconds + step),
            static_cast<float>(step),
            recipe.wind,
            vec3(0, recipe.fire ? recipe.fire->rise : 0, 0)};
}

void fog_velocity(const FogMotion& motion, std::span<const vec3> points, std::span<const float> kelvin,
                  std::span<vec3> velocity) {
    assert(points.size() == velocity.size() && points.size() == kelvin.size());
    HWY_DYNAMIC_DISPATCH(fog_velocity_kernel)(motion, points, kelvin, velocity);
}

void recipe_velocity(const FogRecipe& recipe, double seconds, std::span<const vec3> points,
                     std::span<const float> kelvin, std::span<vec3> velocity) {
    const FogMotion motion = fog_motion(recipe, seconds);
    std::vector<vec3> local;
    for (const vec3& point : points) local.push_back(vec3(dvec3(point) - motion.now.origin));
    fog_velocity(motion, local, kelvin, velocity);
}
}
#endif
