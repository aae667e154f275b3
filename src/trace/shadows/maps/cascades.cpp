// Fits the orthographic cascades of a sun.
#include "trace/shadows/maps/shadow_map.h"
#include "trace/snapshot.h"
#include "trace/view_frustum.h"
#include "volume/bricks/brick_walk.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
constexpr double steps_per_octave = 4; // of texel sizes
constexpr double worth_it = 0.7;       // a cascade's texels are at most this fraction of the next one's size
constexpr int spare = 5;               // texels of margin, for filters at the edge and for snapping
constexpr double endless = std::numeric_limits<double>::infinity();

// A rectangle perpendicular to the light, meters.
struct Rect {
    double low[2] = {endless, endless}, high[2] = {-endless, -endless};

    bool empty() const { return !(low[0] < high[0] && low[1] < high[1]); }
    void grow(const double* at) {
        for (int i = 0; i < 2; ++i) low[i] = std::min(low[i], at[i]), high[i] = std::max(high[i], at[i]);
    }
    void cut(const Rect& other) {
        for (int i = 0; i < 2; ++i) low[i] = std::max(low[i], other.low[i]), high[i] = std::min(high[i], other.high[i]);
    }
};
Rect infinite_rect() {
    Rect all;
    for (int i = 0; i < 2; ++i) all.low[i] = -endless, all.high[i] = endless;
    return all;
}

dvec3 row(const ShadowMap& map, int axis) {
    return {map.world_to_map[0][axis], map.world_to_map[1][axis], map.world_to_map[2][axis]};
}

Rect project(const ShadowMap& map, const Box& box) {
    if (!is_finite(box.low) || !is_finite(box.high)) return infinite_rect();
    Rect result;
    for (int i = 0; i < 8; ++i) {
        const dvec3 offset = dvec3(box.corner(i)) - dvec3(map.position);
        const double at[2] = {glm::dot(row(map, 0), offset), glm::dot(row(map, 1), offset)};
        result.grow(at);
    }
    return result;
}

// What the camera sees between two planar depths, the second one possibly infinite.
Rect project(const ShadowMap& map, const View& view, double near, double far) {
    const Camera& camera = view.camera;
    const vec2 low(-edge_margin(view)), high = vec2(view.size) - low;
    Rect result;
    for (int i = 0; i < 4; ++i) {
        const Ray ray = camera_ray(camera, view.size, {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y});
        const dvec3 d = dvec3(ray.direction) / double(glm::dot(ray.direction, camera.forward));
        const dvec3 start = dvec3(ray.origin) - dvec3(map.position);
        for (const double depth : {near, far}) {
            double at[2];
            for (int axis = 0; axis < 2; ++axis) {
                const double along = glm::dot(row(map, axis), d);
                at[axis] = glm::dot(row(map, axis), start) + (along == 0 ? 0 : along * depth);
            }
            result.grow(at);
            if (!camera.lens) continue;
            const double aside = static_cast<double>(lens_reach(camera.lens, static_cast<float>(depth)));
            for (const double sign : {-1.0, 1.0}) {
                const double beside[2] = {at[0] + sign * aside, at[1] + sign * aside};
                result.grow(beside);
            }
        }
    }
    return result;
}

// Range of planar depths of a box's corners.
Interval<double> depths(const Camera& camera, const Box& box) {
    Interval<double> range{endless, -endless};
    for (int i = 0; i < 8; ++i) {
        const double depth = glm::dot(dvec3(box.corner(i)) - dvec3(camera.position), dvec3(camera.forward));
        range.low = std::min(range.low, depth), range.high = std::max(range.high, depth);
    }
    return range;
}

// A picture whose texel sizes come from a fixed series relative to the scene's extent, on a lattice fixed in the world,
// so that shadow edges do not swim when the camera moves.
ShadowImage fitted_image(const ShadowMap& map, const Rect& region, const Snapshot& snapshot, int resolution) {
    const double unit = snapshot.extent;
    ShadowImage image;
    for (int axis = 0; axis < 2; ++axis) {
        const double length = std::max(region.high[axis] - region.low[axis], 1e-6 * unit) / unit;
        const double texels = resolution - 2 * spare;
        const double texel =
            unit * std::exp2(std::ceil(steps_per_octave * std::log2(length / texels)) / steps_per_octave);
        const double origin = glm::dot(row(map, axis), dvec3(map.position) - dvec3(snapshot.anchor));
        const double low = std::floor((origin + region.low[axis]) / texel) - spare + 1;
        const double wanted = std::ceil((origin + region.high[axis]) / texel) - low + spare - 1;
        image.size[axis] = static_cast<int>(std::clamp<double>(wanted, 2 * spare, resolution));
        image.scale[axis] = static_cast<float>(1 / texel);
        image.offset[axis] = static_cast<float>(origin / texel - low);
    }
    return image;
}
}

void fit_cascades(const View& view, const Snapshot& snapshot, const Box& casters, const ShadowMapOptions& options,
                  ShadowMap& map) {
    // Everything outside the shadow casters' bounds is lit, and only fog in front of the camera needs lookups.
    Box fog;
    for (const Medium& medium : snapshot.media) fog.grow(medium.world_bounds);
    if (fog.empty()) return;
    map.position = casters.center();
    Rect region = project(map, casters);
    region.cut(project(map, fog));
    const bool bounded = is_finite(fog.low) && is_finite(fog.high);
    Interval<double> range = bounded ? depths(view.camera, fog) : Interval<double>{0, endless};
    range.low = std::max(range.low, 0.0);
    if (range.empty()) return;

    // Splits half logarithmic, half uniform; unbounded fog is split where the scene is.
    Box scene = casters;
    scene.grow(snapshot.bounds);
    const double end =
        std::min(range.high, std::max(depths(view.camera, scene).high, range.low + 0.1 * snapshot.extent));
    const double start = std::max(range.low, 0.01 * end);
    std::vector<ShadowImage> images;
    for (int i = options.cascades; i >= 1; --i) {
        const double share = static_cast<double>(i) / options.cascades;
        const double split = 0.5 * start * std::pow(end / start, share) + 0.5 * (start + (end - start) * share);
        Rect seen = project(map, view, range.low, i == options.cascades ? range.high : split);
        seen.cut(region);
        if (seen.empty()) continue;
        const ShadowImage image = fitted_image(map, seen, snapshot, options.resolution);
        const auto density = [](const ShadowImage& p) { return std::sqrt(double(p.scale.x) * p.scale.y); };
        if (!images.empty() && density(images.back()) > worth_it * density(image)) continue;
        images.push_back(image);
    }
    size_t first = 0;
    for (size_t i = images.size(); i-- > 0;) {
        images[i].first = first;
        first += static_cast<size_t>(images[i].size.x) * static_cast<size_t>(images[i].size.y);
        map.images.push_back(images[i]);
    }
}
}
