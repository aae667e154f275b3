// Computes a FogBuffer, and interpolates rays from it.
#include "modes/fog_buffer.h"
#include "modes/resolution.h"

#include "base/parallel.h"
#include "base/random.h"
#include "modes/fog_buffer_mix.h"
#include "modes/history.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "volume/medium.h"
#include "volume/rays/fog_reach.h"

namespace tyndall {
namespace {
constexpr int tile_side = 4;
constexpr uint32_t use_id = 0xf09u; // decorrelates these random numbers from other uses

// A batch of rays to evaluate.
struct Asked {
    size_t count = 0;
    Ray rays[16];
    uint32_t ids[16];
    float jitter[16];
    SamplePlace places[16];
    vec2 positions[16];
    bool open[16];

    RayBatch batch(std::span<vec3> parts) const {
        return {.rays = {rays, count},
                .ids = {ids, count},
                .parts = parts,
                .jitter = {jitter, count},
                .places = {places, count},
                .positions = {positions, count},
                .open = {open, count}};
    }
};

// Sets each ray's end: the first surface, or the end of the fog.
void find_lengths(const Snapshot& snapshot, const Camera& camera, Asked& asked) {
    const std::span rays{asked.rays, asked.count};
    Ray tested[16];
    float skip[16];
    for (size_t i = 0; i < rays.size(); ++i) {
        skip[i] = camera.near / std::max(glm::dot(rays[i].direction, camera.forward), 1e-6f);
        tested[i] = {rays[i].at(skip[i]), rays[i].direction, std::max(rays[i].t_max - skip[i], 0.0f)};
    }
    Hits hits;
    hits.instance.fill(-1);
    if (snapshot.occluders && !snapshot.occluders->empty()) snapshot.occluders->closest({tested, rays.size()}, 0, hits);
    for (size_t i = 0; i < rays.size(); ++i) {
        asked.open[i] = hits.instance[i] < 0;
        rays[i].t_max = asked.open[i] ? fog_reach(snapshot.media, rays[i]) : skip[i] + hits.t[i];
    }
}

void compute_tile(const Snapshot& snapshot, const ScatterFunction& whole, ivec2 corner, FogBuffer& picture) {
    const View& view = picture.view;
    const ivec2 size = picture.fog.size, end = glm::min(corner + tile_side, size);
    ivec2 pixels[16];
    Asked asked;
    Scatter fog[16];
    size_t& count = asked.count;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x, ++count) {
            pixels[count] = {x, y};
            asked.rays[count] = ray_through(picture, {x, y});
            asked.ids[count] = hash(static_cast<uint32_t>(y * size.x + x), view.seed, view.frame, use_id);
            asked.jitter[count] = to_unit(jitter_bits(view.jitter, {x, y}, view.frame, view.seed));
            asked.places[count] = {hash(asked.ids[count], use_id), 0};
            asked.positions[count] = (vec2(x, y) + 0.5f) * vec2(view.size) / vec2(size);
        }
    find_lengths(snapshot, view.camera, asked);
    const size_t part_count = picture.parts.size();
    std::vector<vec3> parts(part_count * count, vec3(0));
    whole(asked.batch(parts), {fog, count});
    for (size_t i = 0; i < count; ++i) {
        const auto [x, y] = std::pair(pixels[i].x, pixels[i].y);
        picture.fog.at(x, y) = fog[i], picture.length.at(x, y) = asked.rays[i].t_max;
        for (size_t p = 0; p < part_count; ++p) picture.parts[p].at(x, y) = parts[i * part_count + p];
    }
}

std::shared_ptr<FogBuffer> compute(const View& view, const Snapshot& snapshot, Resolution share,
                                   const ScatterFunction& whole) {
    const ivec2 size = shared_size(view.size, share);
    auto picture = std::make_shared<FogBuffer>();
    picture->view = view;
    picture->fog = Image<Scatter>(size), picture->length = Image<float>(size);
    picture->age = Image<float>(size, 1.0f);
    if (view.fog_parts) picture->parts.assign(part_count(snapshot.lights.size()), Image<vec3>(size));
    const ivec2 tiles = (size + tile_side - 1) / tile_side;
    parallel_for(int64_t{tiles.x} * tiles.y, [&](int64_t i) {
        compute_tile(snapshot, whole, ivec2(i % tiles.x, i / tiles.x) * tile_side, *picture);
    });
    return picture;
}

bool at_eye(const Camera& camera, const Ray& ray) {
    if (camera.ortho_height > 0)
        return std::abs(glm::dot(ray.origin - camera.position, camera.forward)) <
               0.25f * shadow_offset(camera.position);
    return ray.origin == camera.position;
}

// Interpolates rays from the buffer; those it cannot answer are evaluated together.
void look_up(const FogBuffer& picture, const ScatterFunction& whole, const RayBatch& batch,
             std::span<Scatter> results) {
    const vec2 scale = vec2(picture.fog.size) / vec2(picture.view.size);
    const size_t part_count = batch.rays.empty() ? 0 : batch.parts.size() / batch.rays.size();
    size_t missed[16];
    Asked asked;
    size_t& count = asked.count;
    for (size_t i = 0; i < batch.rays.size(); ++i) {
        const Ray& ray = batch.rays[i];
        const bool known = !batch.positions.empty() && at_eye(picture.view.camera, ray);
        Taps taps = taps_at(picture.fog.size, known ? batch.positions[i] * scale : vec2(0));
        const Mixed fog = known ? mixed(picture, taps, ray.t_max) : Mixed{};
        if (!(fog.weight >= enough) || part_count != picture.parts.size()) {
            missed[count++] = i;
            continue;
        }
        results[i] = fog.fog;
        for (size_t p = 0; p < part_count; ++p) batch.part(i, p) += mixed_light(picture.parts[p], taps);
    }
    if (count == 0) return;

    Scatter fog[16];
    std::vector<vec3> parts(part_count * count, vec3(0));
    for (size_t k = 0; k < count; ++k) {
        const size_t i = missed[k];
        asked.rays[k] = batch.rays[i], asked.ids[k] = batch.ids[i];
        asked.jitter[k] = batch.jitter.empty() ? 0.5f : batch.jitter[i];
        if (!batch.places.empty()) asked.places[k] = batch.places[i];
        if (!batch.positions.empty()) asked.positions[k] = batch.positions[i];
        if (!batch.open.empty()) asked.open[k] = batch.open[i];
    }
    RayBatch rest = asked.batch(parts);
    if (batch.places.empty()) rest.places = {};
    if (batch.positions.empty()) rest.positions = {};
    if (batch.open.empty()) rest.open = {};
    whole(rest, {fog, count});
    for (size_t k = 0; k < count; ++k) {
        results[missed[k]] = fog[k];
        for (size_t p = 0; p < part_count; ++p) batch.part(missed[k], p) += parts[k * part_count + p];
    }
}
}

ivec2 shared_size(ivec2 size, Resolution share) {
    const int divisor = static_cast<int>(share) + 1;
    return (size + divisor - 1) / divisor;
}

ScatterFunction from_fog_buffer(const View& view, const Snapshot& snapshot, const FogBufferOptions& options,
                                ScatterFunction whole, History* history) {
    if (view.camera.lens) return whole;
    std::shared_ptr<FogBuffer> picture = compute(view, snapshot, options.share, whole);
    if (options.blur) blur_pattern(*picture);
    if (history) {
        if (history->picture && history->picture->fog.size == picture->fog.size)
            go_on_from(*history->picture, snapshot.media, *picture);
        history->picture = picture;
    }
    return [picture, whole = std::move(whole)](const RayBatch& batch, std::span<Scatter> results) {
        look_up(*picture, whole, batch, results);
    };
}
}
