#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrate/lights/field_light.cpp"
#include <hwy/foreach_target.h>

#include "integrate/lights/field_light.h"

#include "trace/snapshot.h"
#include "volume/emission/emission_field_simd.h"
#include "volume/rays/emission_nodes.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Emission and extinction at a node.
struct LightAtNode {
    vec3 emission{0};
    float extinction = 0;
};

// Evaluates up to sixteen nodes of one ray.
void look_at(const FieldLight& light, const Medium& field, const Ray& ray, std::span<const EmissionNode> nodes,
             LightAtNode* result) {
    alignas(64) float t[16], v[4][16];
    for (size_t i = 0; i < 16; ++i) t[i] = nodes[std::min(i, nodes.size() - 1)].t;
    const Vec3s point = fma(splat(ray.direction), load(t), splat(ray.origin));
    const Vec3s emission = emission16(field.optics.emission, point);
    Floats extinction = 0.0f;
    for (const Medium& medium : light.fog)
        extinction = fma(density16(medium, point), gray_extinction(medium.optics), extinction);
    store(emission.x, v[0]), store(emission.y, v[1]), store(emission.z, v[2]), store(extinction, v[3]);
    for (size_t i = 0; i < nodes.size(); ++i) result[i] = {vec3(v[0][i], v[1][i], v[2][i]), v[3][i]};
}

// Integrates the emission of one field over the nodes of one ray, which are ascending.
vec3 light_of_nodes(const FieldLight& light, const Medium& field, const Ray& ray, std::span<const EmissionNode> nodes) {
    vec3 sum(0);
    double depth = 0;
    float from = 0, extinction = 0, reach = -infinity; // of the previous node; none yet
    for (size_t first = 0; first < nodes.size(); first += 16) {
        const std::span<const EmissionNode> some = nodes.subspan(first, std::min<size_t>(16, nodes.size() - first));
        LightAtNode at[16];
        look_at(light, field, ray, some, at);
        for (size_t i = 0; i < some.size(); ++i) {
            const float way = some[i].t - from;
            // Use the trapezoidal rule between adjacent nodes, and integrate the fog across gaps.
            if (way <= reach + some[i].length)
                depth += 0.5 * (extinction + at[i].extinction) * way;
            else
                depth += optical_depth(light.fog, {ray.at(from), ray.direction, way});
            from = some[i].t, extinction = at[i].extinction, reach = some[i].length;
            if (depth > light.opaque) return sum;
            const auto seen = static_cast<float>(std::exp(-light.style.view_depth * depth));
            const float fade =
                fades(light.style) ? style_fade(light.style, eye_distance(light.camera, ray.at(from))) : 1;
            sum += at[i].emission * (seen * fade * some[i].length);
        }
    }
    return sum;
}

void field_light_kernel(const FieldLight& light, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local std::vector<EmissionNode> nodes;
    for (const Medium& field : light.fields)
        for (size_t i = 0; i < batch.rays.size(); ++i) {
            nodes.clear();
            find_emission_nodes(*field.density.bricks, batch.rays[i], [](EmissionNode node) { nodes.push_back(node); });
            if (nodes.empty()) continue;
            const vec3 sum = light_of_nodes(light, field, batch.rays[i], nodes);
            results[i].radiance += sum, results[i].steps += static_cast<int>(nodes.size());
            if (!batch.parts.empty()) batch.part(i, batch.index_of(OtherLight::emission)) += sum;
        }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(field_light_kernel);
void add_field_light(const FieldLight& light, const RayBatch& batch, std::span<Scatter> results) {
    HWY_DYNAMIC_DISPATCH(field_light_kernel)(light, batch, results);
}

FieldLight take_fields(Snapshot& snapshot, const StyleSettings& style, const Camera& camera) {
    FieldLight light{{}, {}, style, camera};
    for (const Medium& medium : snapshot.media)
        (only_emits(medium.optics) ? light.fields : light.fog).push_back(medium);
    if (!light.fields.empty()) snapshot.media = light.fog;
    return light;
}

ScatterFunction with_field_light(FieldLight light, ScatterFunction scatter) {
    if (light.fields.empty()) return scatter;
    return [light = std::make_shared<const FieldLight>(std::move(light)),
            scatter = std::move(scatter)](const RayBatch& batch, std::span<Scatter> results) {
        scatter(batch, results);
        add_field_light(*light, batch, results);
    };
}
}
#endif
