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
#include "trace/view.h"
#include "volume/medium.h"
#include "volume/rays/fog_reach.h"

namespace tyndall {
namespace {
constexpr uint32_t use_id = 0xf09u; // decorrelates these random numbers from other uses

// A batch of rays to evaluate.
struct PendingRays {
    size_t count = 0;
    Ray rays[16];
    uint32_t ids[16];
    float jitter[16];
    SampleIndex sample_indices[16];
    vec2 positions[16];
    bool open[16];

    RayBatch batch(std::span<vec3> parts) const {
        return {.rays = {rays, count},
                .ids = {ids, count},
                .parts = parts,
                .jitter = {jitter, count},
                .sample_indices = {sample_indices, count},
                .positions = {positions, count},
                .open = {open, count}};
    }
};

// Sets each ray's end: the first surface, or the end of the fog.
void find_lengths(const Snapshot& snapshot, const Camera& camera, PendingRays& pending) {
    const std::span rays{pending.rays, pending.count};
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
        pending.open[i] = hits.instance[i] < 0;
        rays[i].t_max = pending.open[i] ? fog_reach(snapshot.media, rays[i]) : skip[i] + hits.t[i];
    }
}

void compute_tile(const Snapshot& snapshot, const ScatterFunction& whole, ivec2 corner, FogBuffer& buffer) {
    const View& view = buffer.view;
    const ivec2 size = buffer.fog.size, end = glm::min(corner + tile_side, size);
    ivec2 pixels[16];
    PendingRays pending;
    Scatter fog[16];
    size_t& count = pending.count;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x, ++count) {
            pixels[count] = {x, y};
            pending.rays[count] = ray_through(buffer, {x, y});
            pending.ids[count] = hash(static_cast<uint32_t>(y * size.x + x), view.seed, view.frame, use_id);
            pending.jitter[count] = to_unit(jitter_bits(view.jitter, {x, y}, view.frame, view.seed));
            pending.sample_indices[count] = {hash(pending.ids[count], use_id), 0};
            pending.positions[count] = (vec2(x, y) + 0.5f) * vec2(view.size) / vec2(size);
        }
    find_lengths(snapshot, view.camera, pending);
    const size_t part_count = buffer.parts.size();
    std::vector<vec3> parts(part_count * count, vec3(0));
    whole(pending.batch(parts), {fog, count});
    for (size_t i = 0; i < count; ++i) {
        const auto [x, y] = std::pair(pixels[i].x, pixels[i].y);
        buffer.fog.at(x, y) = fog[i], buffer.length.at(x, y) = pending.rays[i].t_max;
        for (size_t p = 0; p < part_count; ++p) buffer.parts[p].at(x, y) = parts[i * part_count + p];
    }
}

std::shared_ptr<FogBuffer> compute(const View& view, const Snapshot& snapshot, Resolution resolution,
                                   const ScatterFunction& whole) {
    const ivec2 size = reduced_size(view.size, resolution);
    auto buffer = std::make_shared<FogBuffer>();
    buffer->view = view;
    buffer->fog = Image<Scatter>(size), buffer->length = Image<float>(size);
    buffer->age = Image<float>(size, 1.0f);
    if (view.fog_parts) buffer->parts.assign(part_count(snapshot.lights.size()), Image<vec3>(size));
    const ivec2 tiles = (size + tile_side - 1) / tile_side;
    parallel_for(int64_t{tiles.x} * tiles.y, [&](int64_t i) {
        compute_tile(snapshot, whole, ivec2(i % tiles.x, i / tiles.x) * tile_side, *buffer);
    });
    return buffer;
}

bool at_eye(const Camera& camera, const Ray& ray) {
    if (camera.ortho_height > 0)
        return std::abs(glm::dot(ray.origin - camera.position, camera.forward)) <
               0.25f * shadow_offset(camera.position);
    return ray.origin == camera.position;
}

// A ray's length, at most that of the buffer's: open rays may come with that of another channel's fog.
float length_in_fog(std::span<const Medium> media, const RayBatch& batch, size_t i) {
    const Ray& ray = batch.rays[i];
    const bool open = !batch.open.empty() && batch.open[i];
    return open ? std::min(fog_reach(media, {ray.origin, ray.direction, infinity}), ray.t_max) : ray.t_max;
}

// Interpolates rays from the buffer; those it cannot answer are evaluated together.
void look_up(const FogBuffer& buffer, std::span<const Medium> media, const ScatterFunction& whole,
             const RayBatch& batch, std::span<Scatter> results) {
    const vec2 scale = vec2(buffer.fog.size) / vec2(buffer.view.size);
    const size_t part_count = batch.rays.empty() ? 0 : batch.parts.size() / batch.rays.size();
    size_t missed[16];
    PendingRays pending;
    size_t& count = pending.count;
    for (size_t i = 0; i < batch.rays.size(); ++i) {
        const Ray& ray = batch.rays[i];
        const bool known = !batch.positions.empty() && at_eye(buffer.view.camera, ray);
        Taps taps = taps_at(buffer.fog.size, known ? batch.positions[i] * scale : vec2(0));
        const Mixed fog = known ? mixed(buffer, taps, length_in_fog(media, batch, i)) : Mixed{};
        if (!(fog.weight >= min_weight) || part_count != buffer.parts.size()) {
            missed[count++] = i;
            continue;
        }
        results[i] = fog.fog;
        for (size_t p = 0; p < part_count; ++p) batch.part(i, p) += mixed_light(buffer.parts[p], taps);
    }
    if (count == 0) return;

    Scatter fog[16];
    std::vector<vec3> parts(part_count * count, vec3(0));
    for (size_t k = 0; k < count; ++k) {
        const size_t i = missed[k];
        pending.rays[k] = batch.rays[i], pending.ids[k] = batch.ids[i];
        pending.jitter[k] = batch.jitter.empty() ? 0.5f : batch.jitter[i];
        if (!batch.sample_indices.empty()) pending.sample_indices[k] = batch.sample_indices[i];
        if (!batch.positions.empty()) pending.positions[k] = batch.positions[i];
        if (!batch.open.empty()) pending.open[k] = batch.open[i];
    }
    RayBatch rest = pending.batch(parts);
    if (batch.sample_indices.empty()) rest.sample_indices = {};
    if (batch.positions.empty()) rest.positions = {};
    if (batch.open.empty()) rest.open = {};
    whole(rest, {fog, count});
    for (size_t k = 0; k < count; ++k) {
        results[missed[k]] = fog[k];
        for (size_t p = 0; p < part_count; ++p) batch.part(missed[k], p) += parts[k * part_count + p];
    }
}
}

ivec2 reduced_size(ivec2 size, Resolution resolution) {
    const int divisor = static_cast<int>(resolution) + 1;
    return (size + divisor - 1) / divisor;
}

ScatterFunction from_fog_buffer(const View& view, const Snapshot& snapshot, const FogBufferOptions& options,
                                ScatterFunction whole, History* history) {
    if (view.camera.lens) return whole;
    std::shared_ptr<FogBuffer> buffer = compute(view, snapshot, options.resolution, whole);
    if (options.blur) blur_pattern(*buffer);
    if (history) {
        if (history->buffer && history->buffer->fog.size == buffer->fog.size)
            accumulate_fog(*history->buffer, snapshot.media, *buffer);
        history->buffer = buffer;
    }
    return [buffer, media = snapshot.media, whole = std::move(whole)](
               const RayBatch& batch, std::span<Scatter> results) { look_up(*buffer, media, whole, batch, results); };
}
}
