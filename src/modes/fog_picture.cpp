#include "modes/fog_picture.h"

#include "base/parallel.h"
#include "base/random.h"
#include "volume/fog_reach.h"

namespace tyndall {
namespace {
constexpr int tile_side = 4;
constexpr float alike = 0.05f;      // lengths that differ by less than this share show the same fog
constexpr float enough = 0.2f;      // bilinear weight of like neighbours that a ray needs
constexpr float longest_age = 10;   // frames; older ones count less and less
constexpr uint32_t use_id = 0xf09u; // tells these random numbers from others

bool like(float a, float b) { return std::abs(a - b) <= alike * std::max(a, b); }

Ray ray_through(const FogPicture& picture, ivec2 pixel) {
    return camera_ray(picture.view.camera, picture.fog.size, vec2(pixel) + 0.5f);
}

// From the eye to the first surface, or to the end of the fog.
void find_lengths(const Snapshot& snapshot, const Camera& camera, std::span<Ray> rays) {
    Ray tested[16];
    float skip[16];
    for (size_t i = 0; i < rays.size(); ++i) {
        skip[i] = camera.near / std::max(glm::dot(rays[i].direction, camera.forward), 1e-6f);
        tested[i] = {rays[i].at(skip[i]), rays[i].direction, std::max(rays[i].t_max - skip[i], 0.0f)};
    }
    Hits hits;
    hits.instance.fill(-1);
    if (snapshot.occluders && !snapshot.occluders->empty()) snapshot.occluders->closest({tested, rays.size()}, 0, hits);
    for (size_t i = 0; i < rays.size(); ++i)
        rays[i].t_max = hits.instance[i] >= 0 ? skip[i] + hits.t[i] : fog_reach(snapshot.media, rays[i]);
}

void compute_tile(const Snapshot& snapshot, const ScatterFunction& whole, ivec2 corner, FogPicture& picture) {
    const View& view = picture.view;
    const ivec2 size = picture.fog.size, end = glm::min(corner + tile_side, size);
    ivec2 pixels[16];
    Ray rays[16];
    uint32_t ids[16];
    float jitter[16];
    SamplePlace places[16];
    vec2 positions[16];
    Scatter fog[16];
    size_t count = 0;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x, ++count) {
            pixels[count] = {x, y};
            rays[count] = ray_through(picture, {x, y});
            ids[count] = hash(static_cast<uint32_t>(y * size.x + x), view.seed, view.frame, use_id);
            jitter[count] = to_unit(jitter_bits(view.jitter, {x, y}, view.frame, view.seed));
            places[count] = {hash(ids[count], use_id), 0};
            positions[count] = (vec2(x, y) + 0.5f) * vec2(view.size) / vec2(size);
        }
    find_lengths(snapshot, view.camera, {rays, count});
    const size_t lights = picture.per_light.size();
    std::vector<vec3> parts(lights * count, vec3(0));
    whole({{rays, count}, {ids, count}, parts, {jitter, count}, {places, count}, {}, {positions, count}}, {fog, count});
    for (size_t i = 0; i < count; ++i) {
        const auto [x, y] = std::pair(pixels[i].x, pixels[i].y);
        picture.fog.at(x, y) = fog[i], picture.length.at(x, y) = rays[i].t_max;
        for (size_t l = 0; l < lights; ++l) picture.per_light[l].at(x, y) = parts[i * lights + l];
    }
}

std::shared_ptr<FogPicture> compute(const View& view, const Snapshot& snapshot, PictureShare share,
                                    const ScatterFunction& whole) {
    const ivec2 size = shared_size(view.size, share);
    auto picture = std::make_shared<FogPicture>();
    picture->view = view;
    picture->fog = Image<Scatter>(size), picture->length = Image<float>(size);
    picture->age = Image<float>(size, 1.0f);
    if (view.per_light) picture->per_light.assign(snapshot.lights.size(), Image<vec3>(size));
    const ivec2 tiles = (size + tile_side - 1) / tile_side;
    parallel_for(int64_t{tiles.x} * tiles.y, [&](int64_t i) {
        compute_tile(snapshot, whole, ivec2(i % tiles.x, i / tiles.x) * tile_side, *picture);
    });
    return picture;
}

// Four neighbours of a place in the picture, with their bilinear weights; those outside have none.
struct Taps {
    ivec2 at[4];
    float weight[4];
};
Taps taps_at(ivec2 size, vec2 position) {
    const vec2 p = glm::clamp(position - 0.5f, vec2(0), vec2(size) - 1.0f);
    const ivec2 low = glm::min(ivec2(p), glm::max(size - 2, 0));
    const vec2 share = p - vec2(low);
    Taps taps;
    for (int k = 0; k < 4; ++k) {
        const ivec2 step(k & 1, k >> 1);
        taps.at[k] = glm::min(low + step, size - 1);
        taps.weight[k] = (step.x ? share.x : 1 - share.x) * (step.y ? share.y : 1 - share.y);
    }
    return taps;
}

void add(Scatter& sum, const Scatter& part, float weight) {
    sum.radiance += part.radiance * weight;
    sum.transmittance += part.transmittance * weight, sum.validity += part.validity * weight;
}

// A pixel's share of a sum over some of its neighbours: the sum, and what lights it is made of.
struct Mixed {
    Scatter fog{vec3(0), 0, 0, 0, vec3(0)};
    float weight = 0;
};

// Mean of the taps that show fog of about the same length.
Mixed mixed(const FogPicture& picture, Taps& taps, float length) {
    Mixed result;
    for (int k = 0; k < 4; ++k) {
        if (!like(picture.length.at(taps.at[k].x, taps.at[k].y), length)) taps.weight[k] = 0;
        add(result.fog, picture.fog.at(taps.at[k].x, taps.at[k].y), taps.weight[k]);
        result.weight += taps.weight[k];
    }
    if (result.weight > 0) {
        Scatter mean{vec3(0), 0, 0, 0, vec3(0)};
        add(mean, result.fog, 1 / result.weight);
        result.fog = mean;
        for (float& weight : taps.weight) weight /= result.weight;
    }
    return result;
}

vec3 mixed_light(const Image<vec3>& part, const Taps& taps) {
    vec3 sum(0);
    for (int k = 0; k < 4; ++k) sum += part.at(taps.at[k].x, taps.at[k].y) * taps.weight[k];
    return sum;
}

// Averages every pixel with those of like length around it: weights ½ 1 1 1 ½ along each side hold every phase of a
// 4×4 pattern equally often.
void blur_pattern(FogPicture& picture) {
    const ivec2 size = picture.fog.size;
    const FogPicture source = picture;
    parallel_for(size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < size.x; ++x) {
            Scatter sum{vec3(0), 0, 0, 0, vec3(0)};
            std::vector<vec3> parts(picture.per_light.size(), vec3(0));
            float total = 0;
            for (int j = std::max(y - 2, 0); j <= std::min(y + 2, size.y - 1); ++j)
                for (int i = std::max(x - 2, 0); i <= std::min(x + 2, size.x - 1); ++i) {
                    if (!like(source.length.at(i, j), source.length.at(x, y))) continue;
                    const float weight = (std::abs(i - x) == 2 ? 0.5f : 1) * (std::abs(j - y) == 2 ? 0.5f : 1);
                    add(sum, source.fog.at(i, j), weight), total += weight;
                    for (size_t l = 0; l < parts.size(); ++l) parts[l] += source.per_light[l].at(i, j) * weight;
                }
            Scatter& result = picture.fog.at(x, y);
            const int steps = result.steps;
            result = {vec3(0), 0, 0, steps, vec3(0)};
            add(result, sum, 1 / total);
            for (size_t l = 0; l < parts.size(); ++l) picture.per_light[l].at(x, y) = parts[l] / total;
        }
    });
}

// Least and most light among a pixel and its neighbours: what a light that moved or went out leaves behind lies
// outside.
struct Range {
    vec3 low{infinity}, high{-infinity};
};
Range range_around(const FogPicture& picture, ivec2 pixel) {
    Range range;
    const ivec2 low = glm::max(pixel - 1, 0), high = glm::min(pixel + 1, picture.fog.size - 1);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            range.low = glm::min(range.low, picture.fog.at(x, y).radiance);
            range.high = glm::max(range.high, picture.fog.at(x, y).radiance);
        }
    return range;
}

// Mixes in what the last frame's picture shows at the same places: the ends of the rays.
void go_on_from(const FogPicture& before, FogPicture& picture) {
    const FogPicture now = picture;
    parallel_for(now.fog.size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < now.fog.size.x; ++x) {
            const vec3 place = ray_through(now, {x, y}).at(now.length.at(x, y));
            const std::optional<vec2> seen = pixel_of(before.view.camera, before.fog.size, place);
            if (!seen || glm::any(glm::lessThan(*seen, vec2(0))) ||
                glm::any(glm::greaterThan(*seen, vec2(before.fog.size))))
                continue;
            Taps taps = taps_at(before.fog.size, *seen);
            const Camera& eye = before.view.camera;
            const float length =
                eye.ortho_height > 0 ? glm::dot(place - eye.position, eye.forward) : glm::length(place - eye.position);
            const Mixed old = mixed(before, taps, length);
            if (!(old.weight >= enough) || !is_finite(old.fog.radiance)) continue;

            float age = 0;
            for (int k = 0; k < 4; ++k) age += before.age.at(taps.at[k].x, taps.at[k].y) * taps.weight[k];
            age = std::min(age + 1, longest_age);
            const Range range = range_around(now, {x, y});
            const float share = 1 / age;
            Scatter& fog = picture.fog.at(x, y);
            fog.radiance = glm::mix(glm::clamp(old.fog.radiance, range.low, range.high), fog.radiance, share);
            fog.transmittance = glm::mix(old.fog.transmittance, fog.transmittance, share);
            picture.age.at(x, y) = age;
            // Parts keep their shares of the whole.
            for (size_t l = 0; l < now.per_light.size(); ++l)
                picture.per_light[l].at(x, y) *= fog.radiance / glm::max(now.fog.at(x, y).radiance, vec3(1e-30f));
        }
    });
}

bool at_eye(const Camera& camera, const Ray& ray) {
    if (camera.ortho_height > 0) return std::abs(glm::dot(ray.origin - camera.position, camera.forward)) < 1e-6f;
    return ray.origin == camera.position;
}

// Finds the rays in the picture; those it does not show are computed together.
void look_up(const FogPicture& picture, const ScatterFunction& whole, const RayBatch& batch,
             std::span<Scatter> results) {
    const vec2 scale = vec2(picture.fog.size) / vec2(picture.view.size);
    const size_t lights = batch.rays.empty() ? 0 : batch.per_light.size() / batch.rays.size();
    size_t missed[16], count = 0;
    for (size_t i = 0; i < batch.rays.size(); ++i) {
        const Ray& ray = batch.rays[i];
        const bool known = !batch.positions.empty() && at_eye(picture.view.camera, ray);
        Taps taps = taps_at(picture.fog.size, known ? batch.positions[i] * scale : vec2(0));
        const Mixed fog = known ? mixed(picture, taps, ray.t_max) : Mixed{};
        if (!(fog.weight >= enough) || lights != picture.per_light.size()) {
            missed[count++] = i;
            continue;
        }
        results[i] = fog.fog;
        for (size_t l = 0; l < lights; ++l) batch.per_light[i * lights + l] += mixed_light(picture.per_light[l], taps);
    }
    if (count == 0) return;

    Ray rays[16];
    uint32_t ids[16];
    float jitter[16];
    SamplePlace places[16];
    vec2 positions[16];
    Scatter fog[16];
    std::vector<vec3> parts(lights * count, vec3(0));
    for (size_t k = 0; k < count; ++k) {
        const size_t i = missed[k];
        rays[k] = batch.rays[i], ids[k] = batch.ids[i];
        jitter[k] = batch.jitter.empty() ? 0.5f : batch.jitter[i];
        if (!batch.places.empty()) places[k] = batch.places[i];
        if (!batch.positions.empty()) positions[k] = batch.positions[i];
    }
    const auto given = [count](const auto& from, const auto* values) {
        return std::span(values, from.empty() ? 0 : count);
    };
    whole({{rays, count},
           {ids, count},
           parts,
           {jitter, count},
           given(batch.places, places),
           {},
           given(batch.positions, positions)},
          {fog, count});
    for (size_t k = 0; k < count; ++k) {
        results[missed[k]] = fog[k];
        for (size_t l = 0; l < lights; ++l) batch.per_light[missed[k] * lights + l] += parts[k * lights + l];
    }
}
}

ivec2 shared_size(ivec2 size, PictureShare share) {
    const int divisor = static_cast<int>(share) + 1;
    return (size + divisor - 1) / divisor;
}

ScatterFunction from_fog_picture(const View& view, const Snapshot& snapshot, const FogPictureOptions& options,
                                 ScatterFunction whole, History* history) {
    std::shared_ptr<FogPicture> picture = compute(view, snapshot, options.share, whole);
    if (options.blur) blur_pattern(*picture);
    if (history) {
        if (history->picture && history->picture->fog.size == picture->fog.size)
            go_on_from(*history->picture, *picture);
        history->picture = picture;
    }
    return [picture, whole = std::move(whole)](const RayBatch& batch, std::span<Scatter> results) {
        look_up(*picture, whole, batch, results);
    };
}
}
