#include "measure/stress/authored.h"

#include "base/image.h"
#include "modes/froxel/settings.h"
#include "render/sequence/job.h"
#include "scene/lights/light_filter.h"

namespace tyndall {
StressMeasure default_measure() { return {0.1, with_bias, error_and_bias, -1, {}, 0.02}; }

Medium thin_haze(float extinction, const Phase& phase) {
    return homogeneous_medium(extinction, {vec3(-3), vec3(3)}, phase);
}

std::vector<Medium> burning(const Flame& flame) {
    const float h = flame.height;
    FogRecipe recipe;
    recipe.bounds = {flame.base + h * vec3(-0.6f, 0, -0.6f), flame.base + h * vec3(0.6f, 1.5f, 0.6f)};
    recipe.voxel_size = h / 12, recipe.noise.scale = 0.4f * h;
    recipe.threshold = 0.4f, recipe.gain = 3, recipe.soft_edge = 0.2f, recipe.border = h * vec3(0.15f, 0, 0.15f);
    FireRecipe& fire = recipe.fire.emplace();
    fire.base = flame.base, fire.height = h, fire.radius = 0.3f * h, fire.taper = 2;
    fire.core = flame.core, fire.edge = flame.edge, fire.noise.scale = 0.25f * h;

    Scene scene;
    MediumSource& source = scene.media.emplace_back();
    source.name = "fire", source.kind = MediumKind::noise, source.recipe = recipe;
    source.extinction = flame.smoke, source.albedo = vec3(0.7f);
    BlackbodySource& blackbody = source.blackbody.emplace();
    blackbody.kind = flame.kind, blackbody.by_absorption = flame.kind == BlackbodyKind::pbrt;
    return make_snapshot(scene, Moment{0, 0}).media;
}

Light face_light(LightKind kind, vec3 center, vec3 normal, vec2 half) {
    AreaShape shape;
    shape.kind = kind, shape.center = center, shape.normal = glm::normalize(normal), shape.half = half;
    const LightAxes axes = light_axes(shape.normal, {0, 1, 0}, 0);
    shape.right = axes.right, shape.up = axes.up;
    Light light;
    light.name = "face", light.position = center, light.direction = shape.normal;
    light.intensity = vec3(face_area(shape));
    make_punctual(shape, light);
    return light;
}

std::shared_ptr<const Environment> sky_of(int columns, const std::function<vec3(vec3)>& radiance) {
    auto image = std::make_shared<Image<vec3>>(ivec2(columns, columns / 2));
    for (int y = 0; y < image->size.y; ++y)
        for (int x = 0; x < columns; ++x) {
            const float polar = pi * (static_cast<float>(y) + 0.5f) / static_cast<float>(image->size.y);
            const float turn = 2 * pi * ((static_cast<float>(x) + 0.5f) / static_cast<float>(columns) - 0.5f);
            image->at(x, y) =
                radiance({std::sin(polar) * std::sin(turn), std::cos(polar), -std::sin(polar) * std::cos(turn)});
        }
    BackgroundState map;
    map.kind = BackgroundKind::image, map.image = image, map.lat_long = true;
    return make_environment(map);
}

namespace {
// A scene at `count` moments of its shutter; 0 = the default count.
StressScene at_moments(std::shared_ptr<Scene> scene, int count) {
    RenderRequest request;
    request.resolution = authored_size, request.time_samples = count;
    request.settings.path.orders = 1, request.settings.of<FroxelSettings>().tile = 1;
    request.settings.pixel.filter = PixelFilter::box, request.settings.pixel.filter_radius = 0.5f;
    request.settings.pixel.lamp_samples = request.settings.pixel.edge_samples = 1;
    StressScene result;
    result.snapshot = make_snapshot(*scene, moments_of(*scene, request, 0));
    result.view = view_of(*scene, request, request.settings, 0);
    result.settings = request.settings, result.scene = std::move(scene);
    return result;
}
}

StressScene shuttered(Scene scene, double open, double close) {
    auto shared = std::make_shared<Scene>(std::move(scene));
    shared->frame_rate = 1;
    for (CameraSource& camera : shared->cameras) camera.shutter = {open, close, {}};
    StressScene result = at_moments(shared, 0);
    result.finer = std::make_shared<StressScene>(at_moments(shared, 64));
    return result;
}

StressScene authored(std::vector<Medium> media, std::vector<Light> lights, Camera camera, std::vector<Mesh> meshes,
                     std::vector<Material> materials) {
    StressScene scene =
        stress_scene(std::move(media), std::move(lights), camera, std::move(meshes), std::move(materials));
    scene.view.size = authored_size;
    return scene;
}

void use_media(const std::vector<MediumSource>& media, StressScene& scene) {
    Scene only;
    only.media = media;
    Snapshot fog = make_snapshot(only, Moment{0, 0});
    scene.snapshot.media = std::move(fog.media);
    for (const Medium& medium : scene.snapshot.media)
        if (is_finite(medium.world_bounds.size())) scene.snapshot.bounds.grow(medium.world_bounds);
}
}
