// Shadow volumes against triangles counted one by one, and against the slices of
// trace/shadows/intervals/shadow_slices.h.
#include "scene/light.h"
#include "trace/shadows/volumes/shadow_stage.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// A ray through everything, from a random point.
Ray random_ray(uint32_t i, const Box& box) { return {random_point(i, 11, box), random_direction(i, 12), 20}; }

// Lit stretches as the slices see them, from both kinds of eye, and counts as the triangles have them.
void expect_right(const Stage& stage, const Ray& ray) {
    std::vector<Interval<double>> expected;
    find_lit(stage.slices, ray, stage.light, expected);
    const ShadowView from = view_from(stage.volumes, dvec3(ray.origin));
    const ShadowView along = view_along(stage.volumes, dvec3(ray.origin) + dvec3(1, -2, 0.5), dvec3(ray.direction));
    for (const ShadowView& view : {from, along}) {
        Counted counted = crossings_of(view, ray);
        const std::vector<Interval<double>> lit = counted.lit({0, ray.t_max});
        // The slices leave out the last 0.01 % before the light, and both round to 1e-9.
        EXPECT_LT(difference(lit, expected), 2e-4) << "parallel " << view.parallel;
        for (int k = 0; k < 16; ++k) {
            const double t = ray.t_max * (k + 0.37) / 16;
            bool near = false; // too near a crossing to tell
            for (const ShadowCrossing& crossing : counted.crossings)
                near |= std::abs(crossing.t[lane] - t) < 2e-6 * (1 + t);
            if (near) continue;
            const dvec3 point = dvec3(ray.origin) + t * dvec3(ray.direction);
            EXPECT_EQ(counted.at(t), count_between(stage.volumes, point)) << "parallel " << view.parallel;
        }
    }
}

TEST(ShadowVolumes, TheSilhouetteIsWhereFacingChanges) {
    // A sun along an axis sees a box as a square of four edges, each between two faces; two of the caps face it.
    const Stage stage = stage_of({box_of(vec3(0), vec3(1))}, sun_from({0.1f, 1, 0.2f}));
    EXPECT_EQ(stage.volumes.sides.size(), 6u); // seen over a corner: a hexagon
    for (const ShadowVolumes::Side& side : stage.volumes.sides) EXPECT_EQ(std::abs(side.volumes), 2);
    // A single square is its own silhouette, once.
    const Stage open = stage_of({quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2})}, sun_from({0.1f, 1, 0.2f}));
    EXPECT_EQ(open.volumes.sides.size(), 4u);
    for (const ShadowVolumes::Side& side : open.volumes.sides) EXPECT_EQ(std::abs(side.volumes), 1);
}

TEST(ShadowVolumes, CountsTrianglesByHand) {
    const Stage roof = stage_of({quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}), quad({0, 2, -1}, {1, 0, 0}, {0, 0, 2})},
                                sun_from({0, 1, 0}));
    EXPECT_EQ(count_between(roof.volumes, {-0.5, 0, 0.1}), 1);
    EXPECT_EQ(count_between(roof.volumes, {0.5, 0, 0.1}), 2);
    EXPECT_EQ(count_between(roof.volumes, {0.5, 1.5, 0.1}), 1);
    EXPECT_EQ(count_between(roof.volumes, {0.5, 2.5, 0.1}), 0);
    EXPECT_EQ(count_between(roof.volumes, {1.5, 0, 0.1}), 0);
    const Ray level{{-4, 0, 0.1f}, {1, 0, 0}, 8};
    Counted counted = crossings_of(view_from(roof.volumes, dvec3(level.origin)), level);
    ASSERT_EQ(counted.crossings.size(), 4u); // in at 3 and 4, out of both at 5
    for (const ShadowCrossing& crossing : counted.crossings) {
        if (crossing.t[lane] > 4.5f) continue;
        EXPECT_NEAR(crossing.behind[lane], crossing.t[lane] < 3.5f ? 1 : 2, 1e-6);
    }
    const std::vector<Interval<double>> lit = counted.lit({0, 8});
    ASSERT_EQ(lit.size(), 2u);
    EXPECT_NEAR(lit[0].high, 3, 1e-6);
    EXPECT_NEAR(lit[1].low, 5, 1e-6);
}

TEST(ShadowVolumes, BoxesFromAnywhere) {
    for (const LightPoint& light : lights) {
        const Stage stage = stage_of(random_boxes(12), light);
        for (uint32_t i = 0; i < 60; ++i) expect_right(stage, random_ray(i, room));
    }
}

TEST(ShadowVolumes, LooseTrianglesFromAnywhere) {
    // Nothing closed, nothing oriented, everything crossing.
    std::vector<ShadowTriangle> triangles;
    for (uint32_t i = 0; i < 60; ++i) {
        const vec3 p = random_point(i, 1, {vec3(-2), vec3(2)});
        triangles.push_back({{p, p + random_direction(i, 2), p + random_direction(i, 3)}});
    }
    for (const LightPoint& light : lights) {
        const Stage stage = stage_of(triangles, light);
        for (uint32_t i = 0; i < 60; ++i) expect_right(stage, random_ray(i, room));
    }
}

// Meshes with every fault there is, from one that has none.
std::vector<ShadowTriangle> split_faces(std::vector<ShadowTriangle> t) {
    for (size_t i = 0; i < t.size(); i += 2) // corners that do not weld
        for (vec3& corner : t[i].corners) corner *= 1 + 1e-7f;
    return t;
}
std::vector<ShadowTriangle> flipped(std::vector<ShadowTriangle> t, size_t every) {
    for (size_t i = 0; i < t.size(); i += every) std::swap(t[i].corners[0], t[i].corners[1]);
    return t;
}
std::vector<ShadowTriangle> opened(std::vector<ShadowTriangle> t) {
    for (size_t i = 0; i < t.size() / 3; ++i) t.erase(t.begin() + static_cast<long>(2 * i));
    return t;
}
std::vector<ShadowTriangle> doubled(std::vector<ShadowTriangle> t) {
    t.insert(t.end(), t.begin(), t.begin() + static_cast<long>(t.size()));
    return t;
}
std::vector<ShadowTriangle> with_fins(std::vector<ShadowTriangle> t) { // edges of three and four triangles
    const size_t count = t.size();
    for (size_t i = 0; i < count; ++i)
        t.push_back(
            {{t[i].corners[0], t[i].corners[1], t[i].corners[0] + random_direction(static_cast<uint32_t>(i), 9)}});
    return t;
}
std::vector<ShadowTriangle> with_junctions(std::vector<ShadowTriangle> t) { // an edge cut in two on one side only
    std::vector<ShadowTriangle> result;
    for (size_t i = 0; i < t.size(); ++i) {
        const vec3 a = t[i].corners[0], b = t[i].corners[1], c = t[i].corners[2], m = 0.5f * (a + b);
        if (i % 2)
            result.push_back(t[i]);
        else
            result.push_back({{a, m, c}}), result.push_back({{m, b, c}});
    }
    return result;
}

TEST(ShadowVolumes, FaultyMeshes) {
    const std::vector<ShadowTriangle> sound = triangles_of(random_boxes(6));
    for (const auto& triangles : {split_faces(sound), flipped(sound, 1), flipped(sound, 3), opened(sound),
                                  doubled(sound), with_fins(sound), with_junctions(sound)})
        for (const LightPoint& light : lights) {
            const Stage stage = stage_of(triangles, light);
            for (uint32_t i = 0; i < 16; ++i) expect_right(stage, random_ray(i, room));
        }
}

TEST(ShadowVolumes, FlippedNormalsChangeNothing) {
    const std::vector<ShadowTriangle> sound = triangles_of(random_boxes(6));
    for (const LightPoint& light : lights) {
        const Stage a = stage_of(sound, light), b = stage_of(flipped(sound, 1), light);
        for (uint32_t i = 0; i < 30; ++i) {
            const Ray ray = random_ray(i, room);
            const auto lit = [&](const Stage& s) {
                return crossings_of(view_from(s.volumes, dvec3(ray.origin)), ray).lit({0, ray.t_max});
            };
            EXPECT_EQ(difference(lit(a), lit(b)), 0);
        }
    }
}

TEST(ShadowVolumes, TwoBlockersAtOnePlaceAreOne) {
    const std::vector<ShadowTriangle> one = triangles_of(random_boxes(4));
    for (const LightPoint& light : lights) {
        const Stage a = stage_of(one, light), b = stage_of(doubled(one), light);
        for (uint32_t i = 0; i < 30; ++i) {
            const Ray ray = random_ray(i, room);
            const auto lit = [&](const Stage& s) {
                return crossings_of(view_from(s.volumes, dvec3(ray.origin)), ray).lit({0, ray.t_max});
            };
            EXPECT_EQ(difference(lit(a), lit(b)), 0);
        }
    }
}

TEST(ShadowVolumes, EyesInPlanesOfSidesAndRaysThroughCorners) {
    // Everything on a lattice: eyes lie in the planes of sides, above corners and on edges; rays run along faces,
    // through corners, along the light and through it.
    std::vector<Mesh> meshes;
    for (int i = 0; i < 8; ++i)
        if (i != 3) meshes.push_back(box_of(vec3(i & 1, i >> 1 & 1, i >> 2), vec3(i & 1, i >> 1 & 1, i >> 2) + 1.0f));
    meshes.push_back(quad({-2, 2, -2}, {5, 0, 0}, {0, 0, 5}));
    for (const LightPoint& light :
         {sun_from({0, 1, 0}), sun_from({1, 1, 0}), sun_from({1, 1, 1}), lamp_at({0, 4, 0}), lamp_at({1, 3, 1})}) {
        const Stage stage = stage_of(meshes, light);
        uint32_t wrong = 0, asked = 0;
        for (int x = -2; x <= 3; ++x)
            for (int y = -2; y <= 3; ++y)
                for (int z = -2; z <= 3; ++z) {
                    const ShadowView view = view_from(stage.volumes, dvec3(x, y, z));
                    for (int d = 0; d < 27; ++d) {
                        if (d == 13) continue;
                        const vec3 step(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
                        const Ray ray{vec3(x, y, z), glm::normalize(step), 6};
                        Counted counted = crossings_of(view, ray);
                        for (int k = 1; k < 6; k += 2) {
                            // What is within a hair of the ray's point: the answer has to be one of these.
                            const double t = k + 0.31;
                            const dvec3 at = dvec3(ray.origin) + t * dvec3(ray.direction);
                            bool lit = false, dark = false;
                            for (uint32_t n = 0; n < 32 && !(lit && dark); ++n) {
                                const dvec3 off = 1e-5 * dvec3(random_direction(n, 3));
                                (count_between(stage.volumes, at + off) > 0 ? dark : lit) = true;
                            }
                            ++asked;
                            wrong += counted.at(t) > 0 ? !dark : !lit;
                        }
                    }
                }
        EXPECT_EQ(wrong, 0u) << "of " << asked;
    }
}

TEST(ShadowVolumes, AHairOfRotationMovesShadowsByAHair) {
    // A sun in the plane of faces: N·L = 0.
    const std::vector<Mesh> meshes = random_boxes(8);
    const Stage exact = stage_of(meshes, sun_from({0, 1, 0}));
    for (const vec3 turn : {vec3(1e-6f, 0, 0), vec3(-1e-6f, 0, 0), vec3(0, 0, 1e-6f), vec3(1e-6f, 0, -1e-6f)}) {
        LightPoint light{glm::normalize(dvec3(0, 1, 0) + dvec3(turn)), true};
        const Stage turned = stage_of(meshes, light);
        double all = 0, apart = 0;
        for (uint32_t i = 0; i < 200; ++i) {
            const Ray ray = random_ray(i, room);
            const auto lit = [&](const Stage& s) {
                return crossings_of(view_from(s.volumes, dvec3(ray.origin)), ray).lit({0, ray.t_max});
            };
            all += length_of(lit(exact)), apart += difference(lit(exact), lit(turned));
        }
        EXPECT_LT(apart / all, 1e-5);
        EXPECT_GT(all, 100);
    }
}

TEST(ShadowVolumes, APlaneWithAHoleLetsItsLightThrough) {
    // A frame of eight squares around a hole of 1 × 1: its light is as wide everywhere below.
    std::vector<Mesh> meshes;
    for (int i = 0; i < 9; ++i)
        if (i != 4) meshes.push_back(quad({3 * (i % 3) - 4.0f, 1, 3 * (i / 3) - 4.0f}, {3, 0, 0}, {0, 0, 3}));
    for (Mesh& mesh : meshes)
        for (vec3& p : mesh.positions)
            p.x = p.x == -1 ? -0.5f : p.x == 2 ? 0.5f : p.x, p.z = p.z == -1 ? -0.5f : p.z == 2 ? 0.5f : p.z;
    const Stage stage = stage_of(meshes, sun_from({0.2f, 1, 0.1f}));
    double area = 0;
    constexpr int lines = 8000; // a line is 0.0004 of the area
    for (int i = 0; i < lines; ++i) {
        const Ray ray{{-2.5f, 0, 3 * (static_cast<float>(i) + 0.5f) / lines - 1.6f}, {1, 0, 0}, 5};
        area += length_of(crossings_of(view_from(stage.volumes, dvec3(ray.origin)), ray).lit({0, 5})) * 3 / lines;
    }
    EXPECT_NEAR(area, 1, 1e-3);
}

TEST(ShadowVolumes, FarEndsAndGrazingSuns) {
    for (const LightPoint& light : {sun_from({1, 1e-6f, 0}), sun_from({1, 0, 0}), sun_from({-1, 1e-3f, 0.5f})}) {
        const Stage stage = stage_of(random_boxes(6), light);
        for (uint32_t i = 0; i < 30; ++i) {
            Ray ray = random_ray(i, room);
            ray.t_max = 1e6f;
            std::vector<Interval<double>> expected;
            find_lit(stage.slices, ray, stage.light, expected);
            const std::vector<Interval<double>> lit =
                crossings_of(view_from(stage.volumes, dvec3(ray.origin)), ray).lit({0, ray.t_max});
            EXPECT_LT(difference(lit, expected), 1e-6 * ray.t_max);
            for (const Interval<double>& stretch : lit)
                EXPECT_TRUE(std::isfinite(stretch.low) && std::isfinite(stretch.high));
        }
    }
}
}
}
