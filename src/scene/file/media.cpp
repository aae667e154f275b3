// The media of a scene file.
#include "base/error.h"
#include "base/io/file.h"
#include "scene/file/media_grids.h"
#include "scene/file/scene_file.h"
#include "volume/vdb/vdb.h"

#include <charconv>

namespace tyndall {
namespace {
MediumKind kind_named(std::string_view name) {
    if (name == "height") return MediumKind::height;
    if (name == "noise") return MediumKind::noise;
    return name == "vdb" ? MediumKind::vdb : MediumKind::homogeneous;
}

void read_transform(const Field& field, dvec3 origin, MediumSource& medium) {
    const Field translate = field.member("translate");
    medium.translation = translate ? keyed_position(translate, origin) : Keyed<vec3>(vec3(dvec3(0) - origin));
    if (const Field rotate = field.member("rotate"))
        medium.rotate = keyed_vector(rotate), medium.rotation = rotation_of(medium.rotate);
    const Field scale = field.member("scale");
    if (!scale) return;
    medium.scale = keyed_color(scale); // one number or three, like a color
    for (const vec3 value : medium.scale.values)
        if (const char* why = scale_problem(value)) refuse(scale, why);
}

// `origin` is the scene's origin for a medium without a transform, whose own space is then relative to it.
void read_bounds(const Field& field, dvec3 origin, MediumSource& medium) {
    const Field bounds = field.member("bounds");
    if (!bounds) return;
    medium.bounds = {vec3(read_position(bounds.member("low")) - origin),
                     vec3(read_position(bounds.member("high")) - origin)};
    for (int axis = 0; axis < 3; ++axis)
        if (medium.bounds.low[axis] >= medium.bounds.high[axis])
            refuse(bounds.member("high").item(axis), "must be greater than low");
}

// A number or a color; a gray color is a number.
void read_extinction(const Field& field, MediumSource& medium) {
    const Keyed<vec3> channels = keyed_color(field);
    medium.extinction.times = channels.times, medium.extinction.interpolation = channels.interpolation;
    medium.extinction.loop = channels.loop, medium.extinction.values.clear();
    for (const vec3 value : channels.values) medium.extinction.values.push_back(mean_component(value));
    const auto gray = [](vec3 value) { return value.x == value.y && value.x == value.z; };
    medium.channel_extinction.reset();
    if (!std::ranges::all_of(channels.values, gray)) medium.channel_extinction = channels;
}

// Fields that are absent keep their values: the defaults of the recipe or the volume.
void read_optics(const Field& field, MediumSource& medium, Scene& scene) {
    if (const Field extinction = field.member("extinction")) read_extinction(extinction, medium);
    if (const Field albedo = field.member("albedo")) medium.albedo = keyed_color(albedo);
    if (const Field g = field.member("g")) medium.g = keyed_number(g);
    if (const Field emission = field.member("emission")) medium.emission = keyed_color(emission);
    read_phase(field, medium, scene);
}

void read_noise(const Field& field, MediumSource& medium, Scene& scene) {
    const Field recipe = field.member("recipe");
    const std::filesystem::path path = named_file(recipe, scene);
    add_input(scene, path, read_file(path)); // before parsing: a change in between must not keep outdated frames
    medium.recipe = read_recipe(path);
    medium.extinction = medium.recipe->extinction;
    medium.albedo = medium.recipe->albedo;
    medium.g = medium.recipe->g;
    if (const Field voxel_size = field.member("voxel_size")) medium.voxel_size = read_number(voxel_size);
    if (const Field wind = field.member("wind")) medium.recipe->wind = read_vector(wind);
}

// The numbers in a metadata text such as "0.9" or "[0.9, 0.8, 0.7]"; empty if there are none.
std::vector<float> numbers_in(std::string_view text) {
    std::vector<float> numbers;
    while (!text.empty() && numbers.size() < 4) {
        float value;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool good = error == std::errc() && std::isfinite(value);
        if (good) numbers.push_back(value);
        text.remove_prefix(good ? end - text.data() : 1);
    }
    return numbers;
}

// Reads the optics that tyndall bake wrote into the file's metadata and returns whether it has an extinction. Ignores
// values outside the ranges of scene files.
bool read_metadata(const std::filesystem::path& path, MediumSource& medium) {
    bool extinction = false;
    for (const auto& [name, text] : vdb_metadata(path)) {
        const std::vector<float> numbers = numbers_in(text);
        if (numbers.empty()) continue;
        const vec3 color = numbers.size() == 3 ? vec3(numbers[0], numbers[1], numbers[2]) : vec3(numbers[0]);
        if (name == "tyndall_extinction_per_m" && numbers[0] >= 0) medium.extinction = numbers[0], extinction = true;
        if (name == "tyndall_albedo" && glm::all(glm::lessThanEqual(color, vec3(1))) &&
            glm::all(glm::greaterThanEqual(color, vec3(0))))
            medium.albedo = color;
        if (name == "tyndall_g" && std::abs(numbers[0]) <= largest_g) medium.g = numbers[0];
    }
    return extinction;
}

void read_vdb_source(const Field& field, MediumSource& medium, Scene& scene) {
    const Field file = field.member("file");
    with_location(file, [&] { medium.sequence = find_sequence(file.json->string, scene.file.parent_path()); });
    medium.density_grid = field.json->string_or("grid", "");
    if (const Field sequence = field.member("sequence")) {
        medium.sequence.mode = sequence_mode_named(sequence.json->string_or("mode", "hold"));
        medium.sequence.offset = static_cast<int>(sequence.json->number_or("offset", 0));
        const Field blend = sequence.member("blend");
        medium.blends = blend && blend.json->boolean;
        if (medium.blends && medium.sequence.files.empty())
            refuse(blend, "needs a numbered sequence; this is a single file");
    }

    // The first file's metadata applies to the whole sequence.
    if (field.member("extinction") && field.member("albedo") && field.member("g")) return;
    const int first = medium.sequence.files.empty() ? 0 : medium.sequence.files.front() - medium.sequence.offset;
    const auto path = sequence_file(medium.sequence, first, MissingFrame::hold);
    bool known = false;
    if (path) with_location(file, [&] { known = read_metadata(*path, medium); });
    if (!known && !field.member("extinction"))
        warn(scene, file.location() + ": neither the scene nor the file states an extinction; 0.1 per meter is used");
}

MediumSource medium_source(const Field& field, size_t index, Scene& scene) {
    MediumSource medium;
    medium.entry = field.pointer;
    medium.kind = kind_named(field.member("type").json->string);
    medium.name = field.json->string_or("name", "medium " + std::to_string(index + 1));
    if (medium.kind == MediumKind::noise) read_noise(field, medium, scene);
    if (medium.kind == MediumKind::vdb) read_vdb_source(field, medium, scene);
    medium.z_up = field.json->string_or("up_axis", "Y") == "Z";
    read_optics(field, medium, scene);
    read_grids(field, medium, scene);
    const bool moved = field.member("translate") || field.member("rotate") || field.member("scale");
    const bool analytic = medium.kind == MediumKind::homogeneous || medium.kind == MediumKind::height;
    const dvec3 in_bounds = analytic && !moved ? scene.origin : dvec3(0);
    read_bounds(field, in_bounds, medium);
    read_transform(field, scene.origin - in_bounds, medium);
    const Field base = field.member("base");
    medium.height_base = base ? keyed_height(base, scene.origin.y) : Keyed<float>(static_cast<float>(-scene.origin.y));
    if (const Field falloff = field.member("falloff")) medium.height_falloff = keyed_number(falloff);
    return medium;
}
}

SequenceMode sequence_mode_named(std::string_view name) {
    if (name == "loop") return SequenceMode::loop;
    if (name == "ping_pong") return SequenceMode::ping_pong;
    return name == "clip" ? SequenceMode::clip : SequenceMode::hold;
}

void read_media(const Field& root, Scene& scene) {
    const Field media = root.member("media");
    if (!media) return;
    for (size_t i = 0; i < media.json->items.size(); ++i) scene.media.push_back(medium_source(media.item(i), i, scene));
}
}
