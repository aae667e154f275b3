// densities(): the vector sampler behind a plain interface.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/medium.cpp"
#include <hwy/foreach_target.h>

#include "volume/medium.h"

#include "volume/medium_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
void densities_kernel(const Medium& medium, const float* x, const float* y, const float* z, float* density) {
    store(density16(medium, {load(x), load(y), load(z)}), density);
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(densities_kernel);
void densities(const Medium& medium, const float* x, const float* y, const float* z, float* density) {
    HWY_DYNAMIC_DISPATCH(densities_kernel)(medium, x, y, z, density);
}
}
#endif
