// tyndall info: glTF files and scenes.
#include "common.h"
#include "light_units.h"
#include "measure/report/grid_report.h"
#include "reports.h"

#include "base/error.h"
#include "base/text.h"
#include "scene/gltf/gltf.h"
#include "scene/photometry/light_power.h"
#include "scene/pose.h"

namespace tyndall {
namespace {
constexpr const char* medium_names[] = {"homogeneous", "height", "noise", "vdb"};

struct Totals {
    uint64_t triangles = 0, animated_nodes = 0;
    uint64_t deforming = 0; // instances
    float last_key = 0;     // seconds
    Box bounds;             // of the meshes at time 0
};

Totals totals_of(const Scene& scene) {
    Totals totals;
    const auto last_of = [&](const std::vector<float>& times) {
        if (times.size() >= 2) totals.last_key = std::max(totals.last_key, times.back());
        return times.size() >= 2;
    };
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        totals.triangles += mesh.triangles.size();
        const Box box = posed_bounds(mesh, pose_of(scene, instance, 0));
        if (!box.empty()) totals.bounds.grow(transform(instance_matrix(scene, instance, 0), box));
        for (const Keyed<float>& weight : instance.target_weights) last_of(weight.times);
        if (instance.skin >= 0 || !instance.target_weights.empty()) ++totals.deforming;
    }
    for (const Node& node : scene.nodes)
        if (last_of(node.translation.times) | last_of(node.rotation.times) | last_of(node.scale.times))
            ++totals.animated_nodes;
    return totals;
}

Json world_box(const Box& box, dvec3 origin) {
    if (origin == dvec3(0) || box.empty()) return box;
    const auto place = [&](vec3 corner) {
        const dvec3 world = origin + dvec3(corner);
        return Json(std::vector{world.x, world.y, world.z});
    };
    return json_object({{"low", place(box.low)}, {"high", place(box.high)}});
}

Json lights_json(const Scene& scene) {
    return json_list(scene.lights, [](const LightSource& light) {
        return json_object({{"name", light.name},
                            {"kind", traits_of(light.kind).name},
                            {"intensity", native_intensity(light, 0)},
                            {"unit", traits_of(light.kind).unit},
                            {"color", light.color.at(0)},
                            {"temperature", light.temperature.at(0)},
                            {"profile", light.profile != nullptr},
                            {"gobo", light.gobo.has_value()},
                            {"range", light.range.at(0)}});
    });
}

// Mean cosine of the phase function, which most programs call g; also of tables and mixtures.
float mean_cosine_of(const MediumSource& medium) { return mean_cosine(phase_at(medium.phase, medium.g.at(0), 0)); }

Json extinction_json(const MediumSource& medium) {
    return medium.channel_extinction ? Json(medium.channel_extinction->at(0)) : Json(medium.extinction.at(0));
}

std::string extinction_text(const MediumSource& medium) {
    return medium.channel_extinction ? vector_text(medium.channel_extinction->at(0))
                                     : formatted("%g", double{medium.extinction.at(0)});
}

Json media_json(const Scene& scene) {
    return json_list(scene.media, [](const MediumSource& medium) {
        return json_object({{"name", medium.name},
                            {"kind", medium_names[static_cast<int>(medium.kind)]},
                            {"extinction", extinction_json(medium)},
                            {"albedo", medium.albedo.at(0)},
                            {"phase", traits_of(medium.phase.kind).name},
                            {"g", mean_cosine_of(medium)},
                            {"file", medium.sequence.pattern},
                            {"up_axis", medium.z_up ? "Z" : "Y"}});
    });
}

std::string content_json(const std::filesystem::path& file, const char* kind, const Scene& scene) {
    const Totals totals = totals_of(scene);
    std::vector<std::string> cameras, inputs;
    for (const CameraSource& camera : scene.cameras) cameras.push_back(camera.name);
    for (const auto& input : scene.inputs) inputs.push_back(input.path.string());
    return json_line({{"file", file.native()},
                      {"kind", kind},
                      {"frame_rate", scene.frame_rate},
                      {"first_frame", scene.first_frame},
                      {"last_frame", scene.last_frame},
                      {"meshes", scene.meshes.size()},
                      {"instances", scene.instances.size()},
                      {"triangles", totals.triangles},
                      {"materials", scene.materials.size()},
                      {"textures", scene.textures.size()},
                      {"bounds", world_box(totals.bounds, scene.origin)},
                      {"animations", scene.animations},
                      {"animated_nodes", totals.animated_nodes},
                      {"deforming_instances", totals.deforming},
                      {"animation_seconds", totals.last_key},
                      {"cameras", cameras},
                      {"lights", lights_json(scene)},
                      {"media", media_json(scene)},
                      {"light_units", light_units_hint(scene)},
                      {"inputs", inputs},
                      {"warnings", scene.warnings}});
}

std::string lens_text(const CameraSource& camera) {
    const double radius = double{camera.aperture.at(0)};
    return radius > 0 ? formatted(", lens of %g m in radius", radius) : "";
}

std::string shutter_text(const Shutter& shutter) {
    return shutter ? formatted(", shutter open from %g to %g frames", shutter.open, shutter.close) : "";
}

std::string content_text(const Scene& scene) {
    const Totals totals = totals_of(scene);
    std::string text = "  geometry      " + count_text(totals.triangles, "triangle") + " in " +
                       count_text(scene.instances.size(), "instance") + " of " +
                       count_text(scene.meshes.size(), "mesh") + ", " + count_text(scene.materials.size(), "material") +
                       ", " + count_text(scene.textures.size(), "texture") + "\n";
    if (!totals.bounds.empty())
        text += "  world         " + place_text(totals.bounds.low, scene.origin) + " to " +
                place_text(totals.bounds.high, scene.origin) + " m\n";
    if (totals.deforming)
        text += "  deforming     " + count_text(totals.deforming, "instance") + ", by skins or morph targets\n";
    if (totals.last_key > 0)
        text += "  animation     " +
                (totals.animated_nodes ? count_text(totals.animated_nodes, "node") + ", " : std::string()) +
                seconds_text(double{totals.last_key}) + "\n";
    for (const std::string& name : scene.animations) text += "  clip          " + printable(name, 80) + "\n";
    for (const CameraSource& camera : scene.cameras)
        text += "  camera        " + printable(camera.name.empty() ? "(no name)" : camera.name, 80) +
                (is_orthographic(camera) ? ", orthographic"
                                         : formatted(", vertical field of view %.1f degrees",
                                                     glm::degrees(double{camera.vertical_fov.at(0)}))) +
                lens_text(camera) + shutter_text(camera.shutter) + "\n";
    for (const LightSource& light : scene.lights)
        text += formatted("  light         %s, %s, %g %s%s%s\n",
                          printable(light.name.empty() ? "(no name)" : light.name, 80).c_str(),
                          std::string(traits_of(light.kind).name).c_str(), double{native_intensity(light, 0)},
                          std::string(traits_of(light.kind).unit).c_str(),
                          light.profile ? " at the peak of its profile" : "", light.gobo ? ", with a gobo" : "");
    const std::string hint = light_units_hint(scene);
    if (!hint.empty()) text += "  light units   " + hint + "\n";
    for (const MediumSource& medium : scene.media)
        text +=
            formatted("  fog           %s, %s, extinction %s /m, albedo %s, %s, g %.4g%s%s%s\n",
                      printable(medium.name.empty() ? "(no name)" : medium.name, 80).c_str(),
                      medium_names[static_cast<int>(medium.kind)], extinction_text(medium).c_str(),
                      vector_text(medium.albedo.at(0)).c_str(), std::string(traits_of(medium.phase.kind).name).c_str(),
                      double{mean_cosine_of(medium)}, medium.z_up ? ", Z up" : "",
                      medium.sequence.pattern.empty() ? "" : ", ", printable(medium.sequence.pattern).c_str());
    for (const std::string& warning : scene.warnings) text += "  warning       " + printable(warning, 400) + "\n";
    return text;
}
}

std::string gltf_report(const std::filesystem::path& file, bool json) {
    Scene scene;
    scene.file = file;
    load_gltf(file, {}, scene);
    if (json) return content_json(file, "gltf", scene);
    return printable(file.string()) + ": glTF\n" + content_text(scene);
}

std::string scene_report(const std::filesystem::path& file, bool json) {
    const Scene scene = load_scene(file);
    if (json) return content_json(file, "scene", scene);
    std::string text =
        formatted("%s: scene, frames %d to %d at %g per second, %d x %d pixels\n", printable(file.string()).c_str(),
                  scene.first_frame, scene.last_frame, scene.frame_rate, scene.resolution.x, scene.resolution.y);
    text += content_text(scene);
    for (const auto& input : scene.inputs) text += "  reads         " + printable(input.path.string()) + "\n";
    return text;
}

std::string recipe_report(const std::filesystem::path& file, bool json) {
    const FogRecipe recipe = read_recipe(file);
    const dvec3 size = dvec3(recipe.bounds.high) - dvec3(recipe.bounds.low);
    const vec3 across = glm::ceil(size / recipe.voxel_size - 0.5); // voxel centers, as tyndall bake places them
    if (json)
        return json_line({{"file", file.native()},
                          {"kind", "recipe"},
                          {"name", recipe.name},
                          {"bounds", recipe.bounds},
                          {"voxel_size", recipe.voxel_size},
                          {"voxels", across},
                          {"period", recipe.period},
                          {"frame_rate", recipe.frame_rate},
                          {"extinction", recipe.extinction},
                          {"albedo", recipe.albedo},
                          {"g", recipe.g},
                          {"fire", recipe.fire.has_value()},
                          {"hash", recipe_hash(recipe)}});
    std::string text = printable(file.string()) + ": fog recipe for a grid named " + printable(recipe.name, 80) +
                       (recipe.fire ? std::string(" and one named ") + temperature_name : "") + "\n";
    text += "  world         " + vector_text(recipe.bounds.low) + " to " + vector_text(recipe.bounds.high) + " m\n";
    text += formatted("  voxels        %.0f x %.0f x %.0f of %g m\n", double{across.x}, double{across.y},
                      double{across.z}, double{recipe.voxel_size});
    text += formatted("  optics        extinction %g /m at density 1, albedo %s, g %g\n", double{recipe.extinction},
                      vector_text(recipe.albedo).c_str(), double{recipe.g});
    if (const auto& fire = recipe.fire)
        text += formatted("  fire          %g m high, %g to %g K\n", double{fire->height}, double{fire->edge},
                          double{fire->core});
    text += recipe.period > 0 ? formatted("  motion        repeats after %g s (%g frames)\n", recipe.period,
                                          recipe.period * recipe.frame_rate)
                              : std::string("  motion        does not repeat\n");
    return text;
}
}
