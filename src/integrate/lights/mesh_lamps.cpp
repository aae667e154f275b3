#include "integrate/lights/mesh_lamps.h"

#include "base/random.h"
#include "integrate/lights/lamps.h"
#include "integrate/style.h"
#include "scene/lights/light_filter.h"
#include "scene/photometry/ies_file.h"
#include "scene/photometry/ies_profile.h"
#include "scene/scene.h"
#include "trace/frame_cache.h"
#include "trace/lights/emissive_triangles.h"
#include "trace/occlusion/occluders.h"

#include <algorithm>
#include <numeric>

namespace tyndall {
namespace {
constexpr uint32_t points_asked = 1 << 12, points_of_lamp = 512;
constexpr int row_step = 10, column_step = 15; // angular resolution of a lamp's profile, degrees
constexpr double nearly_even = 0.04;           // relative variation below which a lamp needs no profile

// A point on a surface; candela: intensity along its normal.
struct SurfaceEmission {
    dvec3 position{0}, normal{0}, candela{0};
    double weight = 0; // luminance of the candela
    int instance = 0, casters = -1;
};

struct LampPart {
    std::vector<SurfaceEmission> points;
    dvec3 middle{0}, spread{0}; // weighted mean position, and mean squared distance to it per axis
    double weight = 0;
    std::vector<int> instances; // unique
};

LampPart part_of(std::vector<SurfaceEmission> points) {
    LampPart part;
    for (const SurfaceEmission& point : points) {
        part.weight += point.weight, part.middle += point.weight * point.position;
        if (std::ranges::find(part.instances, point.instance) == part.instances.end())
            part.instances.push_back(point.instance);
    }
    part.middle /= part.weight;
    for (const SurfaceEmission& point : points) {
        const dvec3 offset = point.position - part.middle;
        part.spread += point.weight / part.weight * (offset * offset);
    }
    part.points = std::move(points);
    return part;
}

std::vector<SurfaceEmission> points_of(const EmissiveTriangles& glow, const Snapshot& snapshot) {
    std::vector<SurfaceEmission> points;
    for (uint32_t i = 0; i < points_asked; ++i) {
        const float u = (float(i) + 0.5f) / points_asked;
        const Sample2 pair = sample2(i, hash(0x3e5fu));
        const EmissivePoint point = sample_triangles(glow, *snapshot.occluders, u, {pair.x, pair.y});
        const dvec3 candela = dvec3(point.emission) / (double{point.pdf} * points_asked);
        if (const double weight = luminance(vec3(candela)); weight > 0 && std::isfinite(weight))
            points.push_back({dvec3(point.position), dvec3(point.normal), candela, weight, point.instance,
                              emission_links(snapshot, point.instance).x});
    }
    return points;
}

// Splits a part into two halves of whole meshes, sorted along the axis of largest spread.
std::pair<LampPart, LampPart> halves(const LampPart& part) {
    std::vector<std::pair<double, int>> order;
    const int axis = part.spread.x >= std::max(part.spread.y, part.spread.z) ? 0
                     : part.spread.y >= part.spread.z                        ? 1
                                                                             : 2;
    for (const int instance : part.instances) {
        double sum = 0, weight = 0;
        for (const SurfaceEmission& point : part.points)
            if (point.instance == instance) sum += point.weight * point.position[axis], weight += point.weight;
        order.emplace_back(sum / weight, instance);
    }
    std::ranges::sort(order);
    std::vector<SurfaceEmission> first, second;
    for (const SurfaceEmission& point : part.points) {
        const auto place = std::ranges::find(order, point.instance, &std::pair<double, int>::second) - order.begin();
        (2 * place < std::ssize(order) ? first : second).push_back(point);
    }
    return {part_of(std::move(first)), part_of(std::move(second))};
}

// Error measure of replacing a part by one lamp: weight times spread; 0 for a single mesh, which cannot be split.
double split_error(const LampPart& part) {
    return part.instances.size() < 2 ? 0 : part.weight * (part.spread.x + part.spread.y + part.spread.z);
}

// Keeps a subset of points, evenly spaced in triangle order, rescaled to the same total weight.
void thin_out(LampPart& part) {
    if (part.points.size() <= points_of_lamp) return;
    std::vector<SurfaceEmission> kept;
    double weight = 0;
    for (uint32_t i = 0; i < points_of_lamp; ++i)
        kept.push_back(part.points[i * part.points.size() / points_of_lamp]), weight += kept.back().weight;
    for (SurfaceEmission& point : kept) point.candela *= part.weight / weight, point.weight *= part.weight / weight;
    part.points = std::move(kept);
}

std::vector<LampPart> parts_of(const EmissiveTriangles& glow, const Snapshot& snapshot) {
    const std::vector<SurfaceEmission> points = points_of(glow, snapshot);
    std::vector<LampPart> parts;
    for (const int casters : glow.casters) {
        std::vector<SurfaceEmission> some;
        std::ranges::copy_if(points, std::back_inserter(some),
                             [&](const SurfaceEmission& point) { return point.casters == casters; });
        if (!some.empty()) parts.push_back(part_of(std::move(some)));
    }
    while (!parts.empty() && parts.size() < max_lamps) {
        const auto worst = std::ranges::max_element(parts, {}, split_error);
        if (!(split_error(*worst) > 0)) break;
        auto [one, other] = halves(*worst);
        *worst = std::move(one);
        parts.push_back(std::move(other));
    }
    std::ranges::for_each(parts, thin_out);
    return parts;
}

// Calls visit(point, visible cosine / squared distance) for each point seen from `eye`, a direction if `far`.
template<class Visit>
void look_at(const LampPart& part, const Occluders& glowing, dvec3 eye, bool far, const Visit& visit) {
    Occluders::ShadowRays rays{};
    alignas(64) float shares[16];
    for (size_t first = 0; first < part.points.size(); first += 16) {
        const size_t count = std::min<size_t>(16, part.points.size() - first);
        double facing[16];
        std::fill_n(rays.active, 16, 0);
        for (size_t i = 0; i < count; ++i) {
            const SurfaceEmission& point = part.points[first + i];
            const dvec3 offset = far ? eye : eye - point.position;
            const double distance = glm::length(offset);
            const vec3 direction(offset / distance);
            facing[i] = std::abs(glm::dot(point.normal, offset)) / distance / (far ? 1 : distance * distance);
            const float length = far ? infinity : static_cast<float>(distance);
            rays.set(i, off_surface(vec3(point.normal), {vec3(point.position), direction, length}));
        }
        std::fill_n(shares, 16, 1.0f);
        glowing.transmission(rays, shares);
        for (size_t i = 0; i < count; ++i) visit(part.points[first + i], facing[i] * double{shares[i]});
    }
}

dvec3 seen_from(const LampPart& part, const Occluders& glowing, dvec3 eye, bool far) {
    dvec3 sum(0);
    look_at(part, glowing, eye, far, [&](const SurfaceEmission& point, double share) { sum += share * point.candela; });
    return sum;
}

// The dominant normal axis of the surface, by power iteration.
vec3 axis_of(const LampPart& part) {
    glm::dmat3 sum(0);
    for (const SurfaceEmission& point : part.points)
        sum += point.weight * glm::outerProduct(point.normal, point.normal);
    dvec3 axis = part.points.front().normal + dvec3(1e-3, 2e-3, 3e-3);
    for (int i = 0; i < 32; ++i) axis = glm::normalize(sum * axis);
    return vec3(axis);
}

// Sets the lamp's mean color and its directional intensity as a profile; the lamp's position must be set.
void aim(const LampPart& part, const Occluders& glowing, Light& lamp) {
    auto filter = std::make_shared<LightFilter>();
    filter->direction = lamp.direction = axis_of(part);
    filter->profile_axes = filter->gobo_axes = light_axes(lamp.direction, {0, 1, 0}, 0);
    IesFile file;
    for (int row = 0; row <= 180; row += row_step) file.vertical.push_back(row);
    for (int column = 0; column <= 360; column += column_step) file.horizontal.push_back(column);
    dvec3 mean(0);
    double solid = 0, least = infinity;
    const LightAxes& axes = filter->profile_axes;
    for (size_t column = 0; column + 1 < file.horizontal.size(); ++column)
        for (const double row : file.vertical) {
            const double v = glm::radians(row), h = glm::radians(file.horizontal[column]), sine = std::sin(v);
            const dvec3 direction = sine * (std::cos(h) * dvec3(axes.right) + std::sin(h) * dvec3(axes.up)) +
                                    std::cos(v) * dvec3(lamp.direction);
            const dvec3 candela = seen_from(part, glowing, direction, true);
            file.candela.push_back(luminance(vec3(candela)));
            mean += sine * candela, solid += sine, least = std::min(least, file.candela.back());
        }
    file.candela.insert(file.candela.end(), file.candela.begin(),
                        file.candela.begin() + static_cast<ptrdiff_t>(file.vertical.size()));
    mean /= solid;
    const double average = luminance(vec3(mean)), peak = *std::ranges::max_element(file.candela);
    lamp.intensity = vec3(mean);
    if (!(average > 0) || (peak < (1 + nearly_even) * average && least > (1 - nearly_even) * average)) return;
    lamp.intensity = vec3(mean * (peak / average));
    filter->profile = make_ies_profile(file, "glowing surfaces");
    lamp.filter = std::move(filter);
}

// Relative error of the lamp at a position, compared with the surfaces it approximates.
double off_by(const LampPart& part, const Occluders& glowing, const Light& lamp, dvec3 place) {
    const double exact = luminance(vec3(seen_from(part, glowing, place, false)));
    const dvec3 offset = place - dvec3(lamp.position);
    dvec3 shown = dvec3(lamp.intensity) / glm::dot(offset, offset);
    if (lamp.filter) shown *= filtered(*lamp.filter, glm::normalize(offset));
    const double brightest = luminance(lamp.intensity) / glm::dot(offset, offset);
    return std::abs(luminance(vec3(shown)) - exact) / std::max(exact, lamps_tolerance * brightest);
}

// Distance from the lamp, meters, beyond which its error is within lamps_tolerance, tested in 26 directions.
double reach_of(const LampPart& part, const Occluders& glowing, const Light& lamp) {
    constexpr double farthest = 40, nearer = 0.85; // in radii
    double reach = double{lamp.radius};
    for (int i = 0; i < 27; ++i) {
        const dvec3 direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        if (i == 13) continue;
        for (double d = farthest * double{lamp.radius}; d > reach; d *= nearer)
            if (off_by(part, glowing, lamp, dvec3(lamp.position) + d * glm::normalize(direction)) > lamps_tolerance)
                reach = d;
    }
    return reach;
}

MeshLamps make_lamps(const Snapshot& snapshot, const EmissiveTriangles& glow) {
    MeshLamps result;
    std::vector<bool> glows(snapshot.scene->instances.size());
    for (const EmissiveTriangle& triangle : glow.triangles) glows[static_cast<size_t>(triangle.instance)] = true;
    const auto glowing = Occluders::make(*snapshot.scene, snapshot.seconds, nullptr, &glows);
    for (const int set : glow.casters) {
        std::vector<bool> casters =
            set < 0 ? std::vector<bool>(glows.size(), true) : snapshot.casters[static_cast<size_t>(set)].instances;
        for (size_t i = 0; i < glows.size(); ++i)
            if (glows[i]) casters[i] = false;
        result.casters.push_back({casters, Occluders::make(*snapshot.scene, snapshot.seconds, nullptr, &casters)});
    }
    for (const LampPart& part : parts_of(glow, snapshot)) {
        Light lamp;
        lamp.name = "glowing surface " + std::to_string(result.lamps.size() + 1);
        lamp.position = vec3(part.middle);
        lamp.radius = ball_radius(part.spread);
        lamp.core = 1e-5f * snapshot.extent, lamp.surface_scale = 0;
        lamp.casters =
            static_cast<int>(std::ranges::find(glow.casters, part.points.front().casters) - glow.casters.begin());
        aim(part, *glowing, lamp);
        if (!(max_component(lamp.intensity) > 0)) continue;
        result.reach = std::max(result.reach, reach_of(part, *glowing, lamp));
        result.lamps.push_back(std::move(lamp));
    }
    return result;
}
}

std::shared_ptr<const MeshLamps> mesh_lamps(const Snapshot& snapshot) {
    const auto glow = emissive_triangles(snapshot);
    if (!glow) return nullptr;
    return cached(snapshot, "lamps for glowing surfaces", emission_key(snapshot),
                  [&] { return make_lamps(snapshot, *glow); });
}

Snapshot with_mesh_lamps(Snapshot snapshot, const StyleSettings& style, bool wanted) {
    const auto found = wanted ? mesh_lamps(snapshot) : nullptr;
    if (!found || found->lamps.empty()) return snapshot;
    const int before = static_cast<int>(snapshot.casters.size());
    snapshot.casters.insert(snapshot.casters.end(), found->casters.begin(), found->casters.end());
    for (Light lamp : found->lamps) {
        lamp.casters += before, lamp.intensity *= style.tint;
        snapshot.lights.push_back(std::move(lamp));
    }
    return snapshot;
}
}
