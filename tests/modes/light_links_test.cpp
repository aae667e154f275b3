// Objects without shadows and links of lights, in every mode that has shadows.
#include "base/random.h"
#include "integrate/ray_batch.h"
#include "modes/mode.h"
#include "modes/path/path_rays.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/meshes.h"
#include "support/run_mode.h"
#include "trace/fluence/fluence.h"
#include "trace/lights/emission_surface.h"
#include "trace/occlusion/occluders.h"
#include "trace/small_scenes.h"
#include "trace/surface.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr const char* with_shadows[] = {"march",         "path",      "froxel",     "shadow-map",
                                        "shadow-volume", "billboard", "radial-blur"};

LightSource lamp(const char* name, vec3 position, float radius = 0) {
    LightSource light;
    light.name = name, light.position = position, light.intensity = 10.0f, light.radius = radius;
    return light;
}

// A floor, a wall that ends at a height, fog around them and lamps on both sides; instances 0 floor, 1 wall.
Scene room(std::vector<LightSource> lights) {
    Scene scene;
    add_mesh(scene, floor_of(0, 4));
    add_mesh(scene, box_of({-0.1f, 0, -2}, {0.1f, 1.2f, 2}));
    MediumSource fog;
    fog.name = "fog", fog.extinction = 0.2f, fog.bounds = {vec3(-3, 0, -3), vec3(3, 4, 3)};
    scene.media = {fog};
    CameraSource camera;
    camera.position = vec3(0, 2, 6), camera.target = vec3(0, 1, 0);
    scene.cameras = {camera};
    scene.lights = std::move(lights);
    return scene;
}

// Out of the picture: froxels and paths of the camera know nothing of a bulb there.
const vec3 above(-1, 3.6f, 1);

void add_bulb(Scene& scene, vec3 center, bool casts) {
    add_mesh(scene, box_of(center - 0.05f, center + 0.05f));
    scene.instances.back().casts_shadows = casts;
}

Snapshot at_start(const Scene& scene) { return make_snapshot(scene, moment_of(scene, 1)); }

View camera_view() { return view_of({0, 2, 6}, {0, 1, 0}); }

Settings quick_settings() {
    Settings settings = settings_for(Quality::draft);
    settings.fluence.orders = settings.path.orders = 1;
    return settings;
}

// Parts of path traced light along each ray, the mean of some paths each.
std::vector<vec3> path_parts(const View& view, const Snapshot& snapshot, const std::vector<Ray>& rays, uint32_t paths) {
    const ScatterFunction scatter = find_mode("path").prepare(view, snapshot, quick_settings(), nullptr);
    const size_t parts = part_count(snapshot.lights.size());
    std::vector<vec3> sums(rays.size() * parts, vec3(0));
    for (size_t first = 0; first < rays.size(); first += 16)
        for (uint32_t path = 0; path < paths; ++path) {
            const size_t count = std::min<size_t>(16, rays.size() - first);
            std::vector<vec3> found(count * parts, vec3(0));
            std::vector<Scatter> results(count);
            std::vector<uint32_t> ids;
            for (size_t i = 0; i < count; ++i) ids.push_back(hash(static_cast<uint32_t>(first + i), path));
            scatter({.rays = std::span(rays).subspan(first, count), .ids = ids, .parts = found}, results);
            for (size_t i = 0; i < found.size(); ++i) sums[first * parts + i] += found[i] / static_cast<float>(paths);
        }
    return sums;
}

double total(const std::vector<Scatter>& results) { return mean_of(results) * static_cast<double>(results.size()); }

TEST(LightLinks, ABulbWithoutShadowsIsNotThereForTheLight) {
    for (const float radius : {0.0f, 0.01f}) {
        Scene bare = room({lamp("lamp", above, radius)}), flagged = bare, enclosed = bare;
        add_bulb(flagged, above, false), add_bulb(enclosed, above, true);
        const Snapshot without = at_start(bare), with = at_start(flagged), dark = at_start(enclosed);
        const View view = camera_view();
        const std::vector<Ray> rays = pixel_rays(view, with);
        for (const char* mode : with_shadows) {
            SCOPED_TRACE(std::string(mode) + " radius " + std::to_string(radius));
            const auto expected = run_mode(mode, view, without, quick_settings(), rays);
            const auto found = run_mode(mode, view, with, quick_settings(), rays);
            for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(found[i].radiance, expected[i].radiance) << i;
            if (std::string_view(mode) == "radial-blur" || std::string_view(mode) == "billboard") continue;
            EXPECT_GT(total(expected), 0);
            EXPECT_LT(total(run_mode(mode, view, dark, quick_settings(), rays)), 0.2 * total(expected));
        }
    }
}

TEST(LightLinks, EveryWayToFindShadowsOfAMarch) {
    Scene bare = room({lamp("lamp", above), lamp("other", {1, 0.5f, 1}, 0.05f)}), flagged = bare;
    add_bulb(flagged, above, false);
    const Snapshot without = at_start(bare), with = at_start(flagged);
    const std::vector<Ray> rays = pixel_rays(camera_view(), with);
    for (const Visibility visibility : {Visibility::rays, Visibility::maps, Visibility::intervals, Visibility::exact}) {
        Settings settings = quick_settings();
        settings.march.visibility = visibility;
        const auto expected = run_mode("march", camera_view(), without, settings, rays);
        const auto found = run_mode("march", camera_view(), with, settings, rays);
        for (size_t i = 0; i < rays.size(); ++i)
            ASSERT_EQ(found[i].radiance, expected[i].radiance) << i << " visibility " << static_cast<int>(visibility);
    }
}

TEST(LightLinks, AnObjectShadowsTheLightsThatItIsLinkedTo) {
    Scene both = room({lamp("left", {-1.2f, 0.6f, 0}), lamp("right", {1.2f, 0.6f, 0.5f})}), linked = both, bare = both;
    linked.lights[1].casters = {true, false}; // the wall shadows the left lamp alone
    for (LightSource& light : bare.lights) light.casters = {true, false};
    const View view = camera_view();
    const Snapshot all = at_start(both), some = at_start(linked), none = at_start(bare);
    const std::vector<Ray> rays = pixel_rays(view, all);
    const size_t parts = part_count(2);
    for (const char* mode : {"march", "froxel", "shadow-map", "shadow-volume"}) {
        SCOPED_TRACE(mode);
        std::vector<vec3> shadowed, mixed, open;
        run_mode(mode, view, all, quick_settings(), rays, &shadowed);
        run_mode(mode, view, some, quick_settings(), rays, &mixed);
        run_mode(mode, view, none, quick_settings(), rays, &open);
        double differences = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(mixed[i * parts], shadowed[i * parts]) << i;
            ASSERT_EQ(mixed[i * parts + 1], open[i * parts + 1]) << i;
            differences += luminance(open[i * parts + 1] - shadowed[i * parts + 1]);
        }
        EXPECT_GT(differences, 0);
    }

    // Paths choose between lights: the same on average.
    std::vector<vec3> of_march;
    run_mode("march", view, some, quick_settings(), rays, &of_march);
    const std::vector<vec3> of_path = path_parts(view, some, rays, 8);
    for (size_t light = 0; light < 2; ++light) {
        double path = 0, march = 0;
        for (size_t i = 0; i < rays.size(); ++i)
            path += luminance(of_path[i * parts + light]), march += luminance(of_march[i * parts + light]);
        EXPECT_NEAR(path / march, 1, 0.03) << light;
    }
}

TEST(LightLinks, ALightShinesOnTheObjectsThatItIsLinkedTo) {
    // A white floor under a lamp at height h: I / h² / π nits, of those lamps that are linked to it.
    Scene scene = room({lamp("high", {2, 2, 0}), lamp("low", {2, 1, 0})});
    scene.media.clear();
    const auto seen = [&](std::vector<bool> lit) {
        scene.lights[1].lit = std::move(lit);
        const Snapshot snapshot = at_start(scene);
        const Ray ray{{2, 0.5f, 0}, {0, -1, 0}, 10};
        Hits hits;
        snapshot.occluders->closest({&ray, 1}, 0, hits);
        const SurfacePoint point = snapshot.occluders->surface(ray, hits, 0);
        EXPECT_EQ(point.instance, 0);
        vec3 radiance;
        const vec2 u(0.5f);
        shade_surfaces(snapshot, {}, {&point, 1}, {&u, 1}, {&radiance, 1});

        // The path tracer, where it looks straight down.
        const View view = view_of({2, 0.5f, 0.001f}, {2, 0, 0}, {4, 4}, 0.1f);
        const std::vector<Ray> rays(64, ray);
        double path = 0;
        for (const Scatter& result : run_mode("path", view, snapshot, quick_settings(), rays))
            path += luminance(result.surface) / 64;
        EXPECT_NEAR(path, radiance.x, 1e-4);
        return radiance.x;
    };
    EXPECT_NEAR(seen({}), 10 / pi * (1 + 0.25f), 1e-4);
    EXPECT_NEAR(seen({false, true}), 10 / pi * 0.25f, 1e-4);
    EXPECT_NEAR(seen({true, false}), 10 / pi * (1 + 0.25f), 1e-4);
}

// The room below an even sky of 1 nit, and below a roof.
Scene roofed() {
    Scene scene = room({});
    scene.environment.emplace();
    scene.environment->map.stated = true, scene.environment->map.color = vec3(1);
    add_mesh(scene, box_of({-3.5f, 4.2f, -3.5f}, {3.5f, 4.3f, 3.5f}));
    return scene;
}

RayEstimate along(const char* mode, const Snapshot& snapshot, const Ray& ray, vec3 (*light)(const Scatter&)) {
    return estimate_ray(find_mode(mode).prepare(camera_view(), snapshot, quick_settings(), nullptr), ray, 1024, light);
}

void expect_same(const RayEstimate& a, const RayEstimate& b, const char* what) {
    EXPECT_NEAR(a.value.x, b.value.x, 4.5 * std::hypot(a.error.x, b.error.x) + 1e-6) << what;
    EXPECT_LT(a.error.x, 0.02 * a.value.x + 1e-6) << what;
}

TEST(LightLinks, ARoofShadowsTheSkyThatItIsLinkedTo) {
    Scene dark = roofed(), linked = roofed(), flagged = roofed(), open = roofed();
    linked.environment->casters = {true, true, false};
    flagged.instances[2].casts_shadows = false;
    open.instances.pop_back();
    const Ray ray{{-1, 2, 5}, {0, 0, -1}, 10};
    for (const char* mode : {"march", "path"}) {
        const RayEstimate expected = along(mode, at_start(open), ray, fog_light);
        EXPECT_LT(along(mode, at_start(dark), ray, fog_light).value.x, 0.8 * expected.value.x) << mode;
        for (const Scene* scene : {&linked, &flagged})
            expect_same(along(mode, at_start(*scene), ray, fog_light), expected, mode);
    }
}

// A white floor is as bright as the sky, where that shines on it.
TEST(LightLinks, TheSkyShinesOnTheObjectsThatItIsLinkedTo) {
    for (const bool lit : {true, false}) {
        Scene scene = roofed();
        scene.media.clear(), scene.instances.resize(1);
        scene.environment->lit = {lit};
        const Snapshot snapshot = at_start(scene);
        const Ray ray{{2, 0.5f, 0}, {0, -1, 0}, 10};
        const RayEstimate path = along("path", snapshot, ray, surface_light);
        EXPECT_NEAR(path.value.x, lit ? 1 : 0, 4.5 * path.error.x + 1e-6);
        EXPECT_LT(path.error.x, 0.02);

        Hits hits;
        snapshot.occluders->closest({&ray, 1}, 0, hits);
        const SurfacePoint point = snapshot.occluders->surface(ray, hits, 0);
        std::vector<vec2> u;
        for (uint32_t i = 0; i < 4096; ++i) u.push_back({sample2(i, 1).x, sample2(i, 1).y});
        vec3 radiance;
        shade_surfaces(snapshot, {}, {&point, 1}, u, {&radiance, 1});
        EXPECT_NEAR(radiance.x, lit ? 1 : 0, 0.005);
    }
}

// The room with a glowing box behind the wall; instance 2.
Scene glowing_room() {
    Scene scene = room({});
    Material material = lambert(vec3(0.5f));
    material.emission = vec3(100);
    scene.materials = {lambert(vec3(0.5f)), material};
    for (Mesh& mesh : scene.meshes) mesh.material = 0;
    add_mesh(scene, box_of({1.1f, 0.1f, -0.2f}, {1.3f, 0.3f, 0.2f}));
    scene.meshes.back().material = 1;
    return scene;
}

TEST(LightLinks, AWallShadowsTheEmissiveSurfaceThatItIsLinkedTo) {
    Scene dark = glowing_room(), linked = dark, open = dark;
    linked.instances[2].casters = {true, false, true};
    open.instances.erase(open.instances.begin() + 1);
    const Ray ray{{-1, 1.3f, 5}, {0, 0, -1}, 10}; // above the wall, on its far side
    for (const char* mode : {"march", "path"}) {
        const RayEstimate expected = along(mode, at_start(open), ray, fog_light);
        EXPECT_LT(along(mode, at_start(dark), ray, fog_light).value.x, 0.8 * expected.value.x) << mode;
        expect_same(along(mode, at_start(linked), ray, fog_light), expected, mode);
    }

    // The lamps in its place have its casters.
    const Snapshot with = at_start(linked), shadowed = at_start(dark);
    const std::vector<Ray> rays = pixel_rays(camera_view(), with);
    for (const char* mode : {"froxel", "shadow-map", "shadow-volume"}) {
        const double without_shadow = total(run_mode(mode, camera_view(), with, quick_settings(), rays));
        EXPECT_LT(total(run_mode(mode, camera_view(), shadowed, quick_settings(), rays)), 0.95 * without_shadow)
            << mode;
    }
}

TEST(LightLinks, AnEmissiveSurfaceLightsTheObjectsThatItIsLinkedTo) {
    Scene scene = glowing_room();
    scene.media.clear();
    const Ray ray{{2, 0.5f, 0}, {0, -1, 0}, 10};
    const auto seen = [&](std::vector<bool> lit) {
        scene.instances[2].lit = std::move(lit);
        const Snapshot snapshot = at_start(scene);
        const RayEstimate path = along("path", snapshot, ray, surface_light);
        Hits hits;
        snapshot.occluders->closest({&ray, 1}, 0, hits);
        const SurfacePoint point = snapshot.occluders->surface(ray, hits, 0);
        std::vector<vec2> u;
        for (uint32_t i = 0; i < 1 << 17; ++i) u.push_back({sample2(i, 1).x, sample2(i, 1).y});
        vec3 radiance(0);
        add_emitted_light(emitters_of(snapshot), snapshot, {&point, 1}, u, {&radiance, 1});
        EXPECT_NEAR(path.value.x, radiance.x, 4.5 * path.error.x + 0.02 * radiance.x);
        return radiance.x;
    };
    EXPECT_GT(seen({}), 0.1f);
    EXPECT_NEAR(seen({true, false, false}), seen({}), 1e-6);
    EXPECT_EQ(seen({false, true, true}), 0);
}

TEST(LightLinks, ScatteredLightLeavesABulbWithoutShadows) {
    const vec3 place(-1, 0.8f, 0.3f);
    Scene bare = room({lamp("lamp", place)}), flagged = bare, enclosed = bare;
    add_bulb(flagged, place, false), add_bulb(enclosed, place, true);
    for (Scene* scene : {&flagged, &enclosed}) { // black: a white one would keep what it reflects within
        scene->materials = {lambert(vec3(0))};
        scene->meshes.back().material = 0;
    }
    FluenceSettings settings;
    settings.orders = 4, settings.resolution = 12, settings.paths = 200000;
    const auto light_in = [&](const Scene& scene) {
        const FluenceGrid grid = make_fluence(at_start(scene), settings, 1);
        double sum = 0;
        for (size_t i = 0; i < grid.values.size(); i += 12) sum += grid.values[i];
        return sum;
    };
    const double open = light_in(bare);
    EXPECT_NEAR(light_in(flagged) / open, 1, 0.05);
    EXPECT_LT(light_in(enclosed), 0.02 * open);
}

TEST(LightLinks, SetsAreSharedByLightsAndFrames) {
    Scene scene = room({lamp("a", {-1, 1, 0}), lamp("b", {1, 1, 0}), lamp("c", {1, 1, 1})});
    EXPECT_TRUE(at_start(scene).casters.empty());
    scene.lights[0].casters = scene.lights[2].casters = {true, false};
    const Snapshot first = at_start(scene);
    ASSERT_EQ(first.casters.size(), 1u);
    EXPECT_EQ(first.lights[0].casters, 0);
    EXPECT_EQ(first.lights[1].casters, -1);
    EXPECT_EQ(first.lights[2].casters, 0);
    EXPECT_EQ(shadow_casters(first.lights[1], first), first.occluders);
    EXPECT_EQ(shadow_casters(first.lights[0], first)->triangle_count(), 2u);
    const Snapshot second = make_snapshot(scene, moment_of(scene, 2), &first);
    EXPECT_EQ(second.casters[0].occluders, first.casters[0].occluders);

    scene.lights[1].casters = {false, false};
    EXPECT_EQ(shadow_casters(at_start(scene).lights[1], at_start(scene)), nullptr);
}
}
}
