#include "volume/recipe/leaf.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/recipe/leaf.cpp"
#include <hwy/foreach_target.h>

#include "volume/recipe/fire_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Stores four rows, adjacent in y, of 4 voxels along z at one x.
HWY_INLINE void store_rows(const Floats& values, int i, int j, int k, float* leaf) {
    float rows[16];
    store(values, rows);
    for (int row = 0; row < 4; ++row) std::memcpy(leaf + i * 64 + (j + row) * 8 + k, rows + 4 * row, 4 * sizeof(float));
}

// Packets of 4×4 voxels in y and z: compact, so that many of them are empty.
int fill_leaf_kernel(const FogField& field, const float* x, const float* y, const float* z, float* values) {
    int finished = 0;
    for (int j = 0; j < 8; j += 4)
        for (int k = 0; k < 8; k += 4) {
            float ys[16], zs[16];
            for (int lane = 0; lane < 16; ++lane) ys[lane] = y[j + lane / 4], zs[lane] = z[k + lane % 4];
            Floats column[8];
            if (field.swirl_gain == 0)
                fog_column(field, x, load(ys), load(zs), column, finished);
            else
                for (int i = 0; i < 8; ++i) column[i] = fog_density(field, {x[i], load(ys), load(zs)}, finished);
            for (int i = 0; i < 8; ++i) store_rows(column[i], i, j, k, values);
        }
    return finished;
}

int fill_fire_leaf_kernel(const FogField& field, const float* x, const float* y, const float* z, float* values,
                          float* kelvin) {
    int finished = 0;
    for (int j = 0; j < 8; j += 4)
        for (int k = 0; k < 8; k += 4) {
            float ys[16], zs[16];
            for (int lane = 0; lane < 16; ++lane) ys[lane] = y[j + lane / 4], zs[lane] = z[k + lane % 4];
            for (int i = 0; i < 8; ++i) {
                const FlameSample burning = fire_fog(field, {x[i], load(ys), load(zs)}, finished);
                store_rows(burning.density, i, j, k, values);
                store_rows(burning.kelvin, i, j, k, kelvin);
            }
        }
    return finished;
}

uint32_t boxes_with_fog_kernel(const FogField& field, const FogBoxes& boxes) {
    const Vec3s low{load(boxes.low[0]), load(boxes.low[1]), load(boxes.low[2])};
    const Vec3s high{load(boxes.high[0]), load(boxes.high[1]), load(boxes.high[2])};
    float may[16];
    const Mask16 found = field.fire.burns ? may_hold_fire(field, low, high) : may_hold_fog(field, low, high);
    store(zero_unless(found, 1.0f), may);
    uint32_t bits = 0;
    for (int i = 0; i < 16; ++i) bits |= (may[i] != 0) << i;
    return bits;
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(fill_leaf_kernel);
HWY_EXPORT(fill_fire_leaf_kernel);
HWY_EXPORT(boxes_with_fog_kernel);

int fill_leaf(const FogField& field, const float* x, const float* y, const float* z, std::span<float, 512> values) {
    return HWY_DYNAMIC_DISPATCH(fill_leaf_kernel)(field, x, y, z, values.data());
}
int fill_leaf(const FogField& field, const float* x, const float* y, const float* z, std::span<float, 512> values,
              std::span<float, 512> kelvin) {
    return HWY_DYNAMIC_DISPATCH(fill_fire_leaf_kernel)(field, x, y, z, values.data(), kelvin.data());
}
uint32_t boxes_with_fog(const FogField& field, const FogBoxes& boxes) {
    return HWY_DYNAMIC_DISPATCH(boxes_with_fog_kernel)(field, boxes);
}
}
#endif
