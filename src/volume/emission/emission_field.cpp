#include "volume/emission/emission_field.h"

#include "volume/bricks/bricks.h"
#include "volume/emission/blackbody.h"

namespace tyndall {
namespace {
// Samples three channels; a pool shared by all of them is sampled once.
vec3 sampled(const std::array<std::shared_ptr<const BrickPool>, 3>& pools, vec3 point) {
    const float first = sample_density(*pools[0], point);
    if (pools[1] == pools[0]) return vec3(first);
    return {first, sample_density(*pools[1], point), sample_density(*pools[2], point)};
}
}

vec3 albedo_factor(const AlbedoField& field, vec3 point) {
    const float coverage = sample_density(*field.coverage, point);
    return coverage > 0 ? glm::min(sampled(field.color, point) / coverage, vec3(1)) : vec3(1);
}

vec3 emission_at(const EmissionField& field, vec3 point) {
    vec3 rgb = field.table ? field.table->at(sample_density(*field.source[0], point)) : sampled(field.source, point);
    if (field.strength) rgb *= sample_density(*field.strength, point);
    if (field.absorber) rgb *= sample_density(*field.absorber, point);
    if (field.albedo) rgb *= 1.0f - field.base_albedo * albedo_factor(*field.albedo, point);
    return rgb;
}
}
