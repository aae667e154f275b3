// Reads scene files, bare glTF files and bare volumes into a Scene.
#include "scene/file/scene_file.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"
#include "scene/file/origin.h"
#include "scene/file/scene_words.h"
#include "scene/file/stand_ins.h"
#include "scene/gltf/gltf.h"
#include "scene_schema.h"
#include "volume/vdb/vdb.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <charconv>

namespace tyndall {
namespace {
// "5" or "1-48": the schema has checked the form; negative frames keep their sign.
void read_frames(const Field& field, Scene& scene) {
    const std::string& text = field.json->string;
    const char* end = text.data() + text.size();
    const char* behind = std::from_chars(text.data(), end, scene.first_frame).ptr;
    scene.last_frame = scene.first_frame;
    if (behind != end) std::from_chars(behind + 1, end, scene.last_frame);
    if (scene.last_frame < scene.first_frame) refuse(field, "the last frame comes before the first");
}

void read_general(const Field& root, Scene& scene) {
    scene.frame_rate = root.json->number_or("frame_rate", scene.frame_rate);
    if (const Field frames = root.member("frames")) read_frames(frames, scene);
    if (const Field resolution = root.member("resolution"))
        scene.resolution = {static_cast<int>(resolution.json->items[0].number),
                            static_cast<int>(resolution.json->items[1].number)};
    if (const Field exposure = root.member("exposure"))
        scene.exposure = keyed_number(exposure), scene.own_exposure = true;
    if (const Field ambient = root.member("ambient")) scene.ambient = keyed_color(ambient);
}

// Whether nothing emits light at any time.
bool is_dark(const Scene& scene) {
    const auto black = [](const Keyed<vec3>& color) {
        return std::ranges::all_of(color.values, [](vec3 value) { return value == vec3(0); });
    };
    const Background& back = scene.background;
    return scene.lights.empty() && !scene.environment && black(scene.ambient) && !back.image && black(back.color) &&
           black(back.zenith) && black(back.ground) && std::ranges::none_of(scene.media, emits_light) &&
           std::ranges::all_of(scene.materials, [](const auto& material) { return material.emission == vec3(0); });
}

// A sun is infinitely far away: unbounded homogeneous fog transmits none of its light.
void warn_of_endless_fog(Scene& scene) {
    const auto sun = std::ranges::find_if(scene.lights, [](const LightSource& light) { return is_distant(light); });
    if (sun == scene.lights.end()) return;
    for (const MediumSource& medium : scene.media)
        if (medium.kind == MediumKind::homogeneous && !is_finite(medium.bounds.low) && medium.extinction.at(0) > 0)
            warn(scene, scene.file.string() + ": medium " + medium.name + " fills all space, so no light from " +
                            sun->name + " gets through; give it \"bounds\"");
}

// Notes lights that the scale of a node turns off, always or at some keys.
void note_hidden_lights(Scene& scene) {
    for (const LightSource& light : scene.lights) {
        bool hidden = is_hidden(scene, light, 0), animated = false;
        for (int node = light.node; node >= 0; node = scene.nodes[static_cast<size_t>(node)].parent) {
            const Keyed<vec3>& scale = scene.nodes[static_cast<size_t>(node)].scale;
            animated |= !scale.constant();
            for (size_t i = 0; i < scale.times.size() && !hidden; ++i) {
                const vec3 size = scale.at(scale.times[i]);
                hidden = size.x * size.y * size.z == 0 && is_hidden(scene, light, scale.times[i]);
            }
        }
        if (hidden)
            warn(scene, scene.file.string() + ": " + named("light", light.name) + " is off" +
                            (animated ? " while its node has a scale of 0" : ": its node has a scale of 0"));
    }
}

// The glTF, its animations and whether its lights are used.
void read_gltf(const Field& root, Scene& scene, LoadOptions options) {
    const Field gltf = root.member("gltf"), animations = root.member("gltf_animations");
    const Field lights = root.member("gltf_lights");
    for (const Field& field : {animations, lights})
        if (field && !gltf) refuse(field, "has no effect without a glTF");
    if (!gltf) return;
    if (animations) {
        options.animations.emplace();
        for (const Json& name : animations.json->items) options.animations->push_back(name.string);
    }
    load_gltf(named_file(gltf, scene), options, scene);
    for (size_t i = 0; animations && i < options.animations->size(); ++i)
        if (const std::string& name = (*options.animations)[i]; !std::ranges::count(scene.animations, name))
            refuse(animations.item(i), unknown_name("animation", name, scene.animations));
    if (lights && !lights.json->boolean) scene.lights.clear();
}

void read_scene_document(const Json& document, Scene& scene, const LoadOptions& options) {
    const Field root{&document, scene.file.string(), ""};
    read_general(root, scene);
    read_gltf(root, scene, options);
    scene.origin = far_origin(root, scene);
    read_cameras(root, scene);
    read_objects(root, scene);
    read_lights(root, scene);
    read_media(root, scene);
    read_background(root, scene);
    read_environment(root, scene);
    read_billboards(root, scene);
    if (is_dark(scene)) warn(scene, root.file + ": there is no light: everything will be black");
    warn_of_endless_fog(scene);
    note_hidden_lights(scene);
}
}

std::filesystem::path named_file(const Field& field, const Scene& scene) {
    const std::filesystem::path path = scene.file.parent_path() / field.json->string;
    with_location(field, [&] { check_readable(path); });
    return path;
}

void with_location(const Field& field, const std::function<void()>& read) { within(field.location(), read); }

void warn(Scene& scene, std::string_view text) {
    const std::string line = printable(text, 400);
    if (std::find(scene.warnings.begin(), scene.warnings.end(), line) == scene.warnings.end())
        scene.warnings.push_back(line);
}

void add_input(Scene& scene, const std::filesystem::path& path, std::string_view content) {
    if (std::ranges::find(scene.inputs, path, &InputFile::path) == scene.inputs.end())
        scene.inputs.push_back({path, content_hash(content)});
}

namespace {
Scene load_volume(const std::filesystem::path& file, const LoadOptions& options) {
    Scene scene = load_scene_text(volume_scene_text(file), file, options);
    warn(scene, file.string() +
                    ": a volume by itself; using a sun of 3 lux, some ambient light, a camera that sees all of "
                    "it, and " +
                    formatted("%.3g", static_cast<double>(scene.media[0].extinction.at(0))) +
                    " per meter as its extinction at density 1");
    return scene;
}
}

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
    Scene scene;
    scene.file = file;
    const std::string extension = lower_extension(file);
    if (is_volume_name(file)) return load_volume(file, options);
    for (const char* other : {".blend", ".fbx", ".obj", ".abc", ".usd", ".usda", ".usdc", ".usdz"})
        if (extension == other) refuse(file.string(), "is not supported; export the scene as glTF (.glb or .gltf)");
    for (const char* other : {".ies", ".hdr", ".pic", ".exr", ".png", ".jpg", ".jpeg", ".tif", ".tiff"})
        if (extension == other)
            refuse(file.string(), "is not a scene; name it in the lights or the background of a scene file");
    if (extension == ".gltf" || extension == ".glb") {
        load_gltf(file, options, scene);
        scene.origin = far_origin({}, scene);
        note_hidden_lights(scene);
        add_missing_camera(scene); // before the fog, whose bounds are far larger than what there is to see
        add_missing_light_and_fog(scene);
    } else {
        const std::string text = read_file(file);
        const Json document = parse_json(text, file.string());
        if (document.has("bounds") && document.has("voxel_size"))
            refuse(file.string(),
                   "is a fog recipe, not a scene; name it as \"recipe\" in the \"media\" of a scene file");
        check_schema(document, scene_schema, file.string());
        add_input(scene, scene.file, text);
        read_scene_document(document, scene, options);
        add_missing_camera(scene);
    }
    return scene;
}

Scene load_scene_text(std::string_view text, const std::filesystem::path& file, const LoadOptions& options) {
    Scene scene;
    scene.file = file;
    const Json document = parse_json(text, file.string());
    check_schema(document, scene_schema, file.string());
    read_scene_document(document, scene, options);
    add_missing_camera(scene);
    return scene;
}
}
