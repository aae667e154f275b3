#include "integrate/face_light.h"

#include "integrate/equi_angular.h"
#include "integrate/fog_points.h"
#include "integrate/terms.h"
#include "scene/area_shape.h"
#include "scene/light_reach.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

#include <algorithm>

namespace tyndall {
namespace {
enum Use : uint32_t { use_distance = 0x7fac, use_point = 0x7fad };

constexpr int pairs_for_a_point = 2; // of distances, one by angle and one by fog

// A point of a ray, a way from there to the face, and what comes to the eye if nothing is in the way.
struct FacePath {
    size_t ray = 0;
    Ray way{};
    vec3 light{0};
};

// The two ways to pick distances on a ray, for one light.
struct Distances {
    const FogPieces& fog;
    EquiAngular<double> angles{};
    double low = 0, high = 0; // of the angles
    double factor = 1;        // on the optical depth towards the eye
    double seen = 0;          // ∫ e^(-factor · depth) over the depth of the ray

    double by_angle(double t) const { return t >= low && t <= high ? angles.density(t) : 0; }
    double by_fog(double extinction, double passing) const { return extinction * passing / seen; }
};

// Only what the light reaches is worth asking for.
bool find_distances(const FaceLight& faces, const Light& light, const Ray& ray, const FogPieces& fog,
                    Distances& distances) {
    const Interval<double> reach = light_reach(light, dvec3(ray.origin), dvec3(ray.direction));
    distances.low = std::max(fog.pieces.front().low, reach.low);
    distances.high = std::min(fog.pieces.back().high, reach.high);
    if (!(distances.high > distances.low)) return false;
    const dvec3 offset = dvec3(light.position) - dvec3(ray.origin), direction(ray.direction);
    const double nearest = glm::dot(offset, direction);
    const double height = std::max(glm::length(offset - nearest * direction), double{capped_radius(light)});
    distances.angles = equi_angular(nearest, height, distances.low, distances.high);
    distances.factor = faces.style.view_depth;
    const double factor = distances.factor;
    distances.seen = factor > 0 ? -std::expm1(-factor * fog.depth) / factor : fog.depth;
    return distances.angles.to > distances.angles.from;
}

// The piece of fog that a distance lies in; none in a gap.
size_t piece_at(const FogPieces& fog, double t) {
    const auto after = std::upper_bound(fog.pieces.begin(), fog.pieces.end(), t,
                                        [](double d, const FogPieces::Piece& p) { return d < p.low; });
    const size_t index = static_cast<size_t>(after - fog.pieces.begin());
    return index > 0 && t < fog.pieces[index - 1].high ? index - 1 : fog.pieces.size();
}

// A way from a distance of the ray to the light.
void append_path(const FaceLight& faces, const Light& light, const Ray& ray, const Distances& distances, double t,
                 size_t piece, double count, vec2 u, FacePath path, std::vector<FacePath>& paths) {
    static thread_local FogThere there;
    const double extinction = look_at_fog(distances.fog, piece, ray, t, there);
    if (!(extinction > 0)) return;
    const double passing = std::exp(-distances.factor * distances.fog.depth_at(piece, t));
    const double density = count * (distances.by_angle(t) + distances.by_fog(extinction, passing));
    const AreaSample sample = sample_area(*light.area, there.point, u);
    if (!(density > 0) || !(sample.steradians > 0)) return;
    const float fade = fades(faces.style) ? style_fade(faces.style, eye_distance(faces.camera, there.point)) : 1;
    const double weight = extinction * passing / density * (sample.steradians * fade * light.volume_scale);
    path.light = scattered(faces.fog, there, sample.direction).first * radiance_of(light) * static_cast<float>(weight);
    path.way = {there.point, sample.direction, sample.distance * 0.9999f};
    if (max_component(path.light) > 0) paths.push_back(path);
}

void append_ray(const FaceLight& faces, const Light& light, size_t number, const RayBatch& batch, size_t i,
                const FogPieces& fog, std::vector<FacePath>& paths) {
    const Ray& ray = batch.rays[i];
    Distances distances{fog};
    if (fog.pieces.empty() || !(fog.depth > 0) || !find_distances(faces, light, ray, fog, distances)) return;
    const auto pairs = static_cast<uint32_t>(faces.points * pairs_for_a_point);
    const auto use = static_cast<uint32_t>(2 * number);
    for (uint32_t k = 0; k < pairs; ++k) {
        const vec2 u = point_numbers(batch, i, k, pairs, use_distance + use * 0x9e37u);
        const double t = distances.angles.at(u.x).t;
        const size_t piece = piece_at(fog, t);
        if (piece < fog.pieces.size())
            append_path(faces, light, ray, distances, t, piece, pairs,
                        point_numbers(batch, i, 2 * k, 2 * pairs, use_point + use * 0x9e37u), {i}, paths);

        const double factor = distances.factor;
        const double depth =
            factor > 0 ? -std::log1p(-factor * double{u.y} * distances.seen) / factor : double{u.y} * distances.seen;
        size_t there = 0;
        const double by_fog = distance_at(fog, depth, there);
        append_path(faces, light, ray, distances, by_fog, there, pairs,
                    point_numbers(batch, i, 2 * k + 1, 2 * pairs, use_point + use * 0x9e37u), {i}, paths);
    }
}

// Share of the light of up to 16 paths that surfaces let through.
void pass_surfaces(const Occluders& occluders, std::span<const FacePath> paths, float* shares) {
    Occluders::ShadowRays rays{};
    for (size_t i = 0; i < paths.size(); ++i) rays.set(i, paths[i].way);
    occluders.transmission(rays, shares);
}

void add_paths(const FaceLight& faces, size_t number, std::span<const FacePath> paths, const RayBatch& batch,
               std::span<Scatter> results) {
    for (size_t first = 0; first < paths.size(); first += 16) {
        const auto some = paths.subspan(first, std::min<size_t>(16, paths.size() - first));
        alignas(64) float shares[16];
        std::fill_n(shares, 16, 1.0f);
        if (faces.casters[number]) pass_surfaces(*faces.casters[number], some, shares);
        for (size_t i = 0; i < some.size(); ++i) {
            const FacePath& path = some[i];
            ++results[path.ray].steps;
            if (!(shares[i] > 0)) continue;
            const double depth = faces.light_depth > 0 ? faces.light_depth * optical_depth(faces.fog, path.way) : 0;
            const vec3 added = path.light * (shares[i] * static_cast<float>(std::exp(-depth)));
            results[path.ray].radiance += added;
            if (!batch.parts.empty()) batch.part(path.ray, faces.first + number) += added;
        }
    }
}
}

FaceLight take_faces(Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms, const Camera& camera,
                     bool shadows, float min_transmittance) {
    FaceLight faces;
    const auto first = std::ranges::find_if(snapshot.lights, [](const Light& light) { return light.area != nullptr; });
    faces.first = static_cast<size_t>(first - snapshot.lights.begin());
    faces.lights.assign(first, snapshot.lights.end());
    snapshot.lights.erase(first, snapshot.lights.end());
    for (const Light& light : faces.lights)
        faces.casters.push_back(shadows ? shadow_casters(light, snapshot) : nullptr);
    for (const Medium& medium : snapshot.media)
        if (!only_emits(medium.optics)) faces.fog.push_back(medium);
    faces.style = style, faces.camera = camera, faces.points = terms.light_points;
    faces.light_depth = terms.light == LightTransmittance::off ? 0 : style.light_depth;
    faces.min_transmittance = min_transmittance;
    return faces;
}

void add_face_light(const FaceLight& faces, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local std::vector<FogPieces> fog(16);
    static thread_local std::vector<FacePath> paths;
    for (size_t i = 0; i < batch.rays.size(); ++i) find_fog(batch.rays[i], faces.fog, faces.min_transmittance, fog[i]);
    for (size_t number = 0; number < faces.lights.size(); ++number) {
        paths.clear();
        if (!(faces.lights[number].volume_scale > 0)) continue;
        for (size_t i = 0; i < batch.rays.size(); ++i)
            append_ray(faces, faces.lights[number], number, batch, i, fog[i], paths);
        add_paths(faces, number, paths, batch, results);
    }
}

ScatterFunction with_face_light(FaceLight faces, ScatterFunction scatter) {
    if (faces.lights.empty() || faces.fog.empty()) return scatter;
    return [faces = std::make_shared<const FaceLight>(std::move(faces)),
            scatter = std::move(scatter)](const RayBatch& batch, std::span<Scatter> results) {
        scatter(batch, results);
        add_face_light(*faces, batch, results);
    };
}
}
