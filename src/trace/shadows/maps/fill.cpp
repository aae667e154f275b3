// Fills shadow maps with the first surface of rays from the light, a block of texels at a time.
#include "base/parallel.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/maps/shadow_blocks.h"
#include "trace/snapshot.h"
#include "trace/view_frustum.h"

namespace tyndall {
namespace {
constexpr int max_sheets = 64; // BLEND surfaces passed by one ray

struct Filling {
    const Light& light;
    const Occluders& occluders;
    ShadowMap& map;
    mat3 map_to_world;
    bool has_alpha;
    ViewFrustum seen;
    float start = 0;           // w at which the rays of a sun start, in front of all surfaces
    float nearest = 0;         // distance from a local light at which its rays start
    float smallest_cosine = 0; // to the axis, of texels that the light reaches
};

// The ray through a texel coordinate; w = its t + start.
Ray texel_ray(const Filling& filling, const ShadowImage& image, size_t face, vec2 texel) {
    const vec2 at = (texel - image.offset) / image.scale;
    const ShadowMap& map = filling.map;
    if (map.projection == LightProjection::parallel)
        return {map.position + filling.map_to_world * vec3(at, filling.start), filling.light.direction};
    if (map.projection == LightProjection::perspective)
        return {map.position, filling.map_to_world * glm::normalize(vec3(at, 1))};
    const int axis = static_cast<int>(face) / 2;
    vec3 direction;
    direction[axis] = face % 2 ? -1.0f : 1.0f;
    direction[(axis + 1) % 3] = at.x, direction[(axis + 2) % 3] = at.y;
    return {map.position, glm::normalize(direction)};
}

// Depth of the first surface that blocks a ray, passing BLEND surfaces with alpha below one half one after the other.
float depth_behind_sheets(const Occluders& occluders, Ray ray, float t_min, float depth) {
    Hits hits;
    for (int sheet = 0; sheet < max_sheets; ++sheet) {
        occluders.closest({&ray, 1}, t_min, hits);
        if (hits.instance[0] < 0) return infinity;
        if (occluders.surface(ray, hits, 0).alpha >= 0.5f) return depth + hits.t[0];
        const float step = hits.t[0] + shadow_offset(ray.at(hits.t[0]));
        ray.origin = ray.at(step), depth += step, t_min = 0;
    }
    return depth;
}

// Where lookups that read texels of a block can lie on the ray through its middle.
Interval<float> seen_by_block(const Filling& filling, const ShadowImage& image, const Ray& middle) {
    const float radius =
        (0.5f * block_side + shadow_guard + 0.5f) * std::sqrt(2.0f) / std::min(image.scale.x, image.scale.y);
    const bool parallel = filling.map.projection == LightProjection::parallel;
    return seen_interval(filling.seen, middle.origin - filling.seen.anchor, middle.direction, parallel ? radius : 0,
                         parallel ? 0 : radius);
}

void fill_block(const Filling& filling, const ShadowImage& image, size_t face, ivec2 corner) {
    Ray rays[16];
    int texels[16];
    size_t count = 0;
    const ivec2 end = glm::min(corner + block_side, image.size);
    float* depth = filling.map.depth.data() + image.first;
    const Ray middle = texel_ray(filling, image, face, vec2(corner) + 0.5f * block_side);
    const Interval<float> seen = seen_by_block(filling, image, middle);
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) {
            const int texel = y * image.size.x + x;
            depth[texel] = seen.empty() ? unseen_depth : infinity;
            if (seen.empty()) continue;
            Ray ray = texel_ray(filling, image, face, vec2(x, y) + 0.5f);
            if (glm::dot(ray.direction, filling.light.direction) < filling.smallest_cosine) continue;
            ray.t_max = seen.high;
            rays[count] = ray, texels[count++] = texel;
        }
    if (count == 0) return;

    Hits hits;
    filling.occluders.closest({rays, count}, filling.nearest, hits);
    for (size_t i = 0; i < count; ++i) {
        const int lane = static_cast<int>(i);
        if (hits.instance[i] < 0) continue;
        float w = filling.start + hits.t[i];
        if (filling.has_alpha && filling.occluders.surface(rays[i], hits, lane).alpha < 0.5f)
            w = depth_behind_sheets(filling.occluders, rays[i], filling.nearest, filling.start);
        depth[texels[i]] = w;
    }
}
}

void fill_shadow_map(const View& view, const Snapshot& snapshot, const Light& light, ShadowMap& map) {
    const Occluders& occluders = *shadow_casters(light, snapshot);
    Filling filling{light, occluders, map, glm::transpose(map.world_to_map), occluders.has_alpha(), {}};
    filling.seen = view_frustum(view, snapshot, map.position);
    filling.smallest_cosine = -2;
    if (map.projection == LightProjection::parallel) {
        const Box box = occluders.bounds();
        float first = infinity;
        for (int i = 0; i < 8; ++i) first = std::min(first, glm::dot(box.corner(i) - map.position, light.direction));
        filling.start = first - 0.01f * glm::length(box.size()) - shadow_offset(map.position);
    } else {
        filling.nearest = std::max(light.radius, shadow_offset(light.position));
        // Filters reach two texels beyond the cone.
        const float texel = 1 / map.images[0].scale.x;
        if (has_cone(light)) filling.smallest_cosine = std::cos(std::min(light.outer_cone + 4 * texel, pi));
    }

    size_t texels = 0;
    int64_t rows = 0;
    for (const ShadowImage& image : map.images) {
        texels += static_cast<size_t>(image.size.x) * static_cast<size_t>(image.size.y);
        rows += (image.size.y + block_side - 1) / block_side;
    }
    map.depth.resize(texels);
    parallel_for(rows, [&](int64_t row) {
        size_t face = 0;
        for (;; ++face) {
            const int64_t of_face = (map.images[face].size.y + block_side - 1) / block_side;
            if (row < of_face) break;
            row -= of_face;
        }
        const ShadowImage& image = map.images[face];
        for (int x = 0; x < image.size.x; x += block_side)
            fill_block(filling, image, face, {x, static_cast<int>(row) * block_side});
    });
    make_blocks(map);
}
}
