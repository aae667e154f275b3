#include "integrate/light_point.h"

#include "base/random.h"
#include "scene/light.h"

namespace tyndall {
namespace {
constexpr uint32_t use_light_point = 0x51ce5u; // tells these random numbers from others of the same sample
}

LightPoint light_point(const RayBatch& batch, size_t ray, const Light& light, size_t light_index, uint32_t k,
                       uint32_t count) {
    if (!is_soft(light)) return center_of(light);
    const uint32_t index = static_cast<uint32_t>(light_index);
    Sample2 u, v;
    if (batch.places.empty()) {
        const uint32_t key =
            k ? hash(batch.ids[ray], use_light_point, index, k) : hash(batch.ids[ray], use_light_point, index);
        u = {to_unit(hash(key, 0u)), to_unit(hash(key, 1u))}, v = {to_unit(hash(key, 2u)), 0};
    } else {
        const SamplePlace place = batch.places[ray];
        u = sample2(place.index * count + k, hash(place.sequence, use_light_point, index, 0u));
        v = sample2(place.index * count + k, hash(place.sequence, use_light_point, index, 1u));
    }
    return point_on(light, batch.rays[ray], {u.x, u.y, v.x});
}
}
