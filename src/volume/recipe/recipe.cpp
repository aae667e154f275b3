#include "volume/recipe/recipe.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/json/json.h"
#include "base/text.h"
#include "recipe_schema.h"

namespace tyndall {
namespace {
// Incremented when the same recipe produces different fog.
constexpr int format_version = 1;

float number(const Json& object, std::string_view key, float otherwise) {
    return static_cast<float>(object.number_or(key, otherwise));
}

// Three numbers, or one for all three.
vec3 triple(const Json& object, std::string_view key, vec3 otherwise) {
    const Json* value = object.find(key);
    if (!value) return otherwise;
    if (value->kind == Json::Kind::number) return vec3(static_cast<float>(value->number));
    return {static_cast<float>(value->items[0].number), static_cast<float>(value->items[1].number),
            static_cast<float>(value->items[2].number)};
}

// A member object; an empty one when it is absent.
const Json& part(const Json& object, std::string_view key) {
    static const Json none;
    const Json* found = object.find(key);
    return found ? *found : none;
}

FractalNoise read_noise(const Json& json, FractalNoise noise) {
    noise.octaves = static_cast<int>(json.number_or("octaves", noise.octaves));
    noise.scale = number(json, "scale", noise.scale);
    noise.lacunarity = number(json, "lacunarity", noise.lacunarity);
    noise.gain = number(json, "gain", noise.gain);
    noise.seed = static_cast<uint32_t>(json.number_or("seed", noise.seed));
    noise.evolve = number(json, "evolve", noise.evolve);
    noise.billow = json.boolean_or("billow", noise.billow);
    return noise;
}

void read_density(const Json& document, FogRecipe& recipe) {
    const Json& density = part(document, "density");
    recipe.threshold = number(density, "threshold", recipe.threshold);
    recipe.gain = number(density, "gain", recipe.gain);
    recipe.soft_edge = number(density, "soft_edge", recipe.soft_edge);
    recipe.border = triple(density, "border", recipe.border);

    const Json& shape = part(document, "shape");
    if (shape.string_or("kind", "box") == "ellipsoid") recipe.shape = FogShape::ellipsoid;
    recipe.shape_strength = number(shape, "strength", recipe.shape_strength);
    recipe.shape_level = number(shape, "level", recipe.shape_level);

    const Json& height = part(document, "height");
    recipe.height_base = number(height, "base", recipe.height_base);
    recipe.height_falloff = number(height, "falloff", recipe.height_falloff);
}

void read_motion(const Json& document, FogRecipe& recipe) {
    recipe.wind = triple(document, "wind", recipe.wind);
    const Json& swirl = part(document, "swirl");
    recipe.swirl = number(swirl, "amount", recipe.swirl);
    recipe.swirl_scale = number(swirl, "scale", recipe.swirl_scale);
    recipe.swirl_speed = number(swirl, "speed", recipe.swirl_speed);
    recipe.period = document.number_or("period", recipe.period);
    recipe.frame_rate = document.number_or("frame_rate", recipe.frame_rate);
}

FireRecipe read_fire(const Json& json) {
    FireRecipe fire;
    fire.base = triple(json, "base", fire.base);
    fire.height = number(json, "height", fire.height);
    fire.radius = number(json, "radius", fire.radius);
    fire.taper = number(json, "taper", fire.taper);
    fire.core = number(json, "core", fire.core);
    fire.edge = number(json, "edge", std::min(fire.edge, fire.core));
    fire.air = number(json, "air", std::min(fire.air, fire.edge));
    fire.flicker = number(json, "flicker", fire.flicker);
    fire.rise = number(json, "rise", fire.rise);
    fire.stretch = number(json, "stretch", fire.stretch);
    fire.noise.scale = 0.8f * fire.radius;
    fire.noise = read_noise(part(json, "noise"), fire.noise);
    fire.soot = number(json, "soot", fire.soot);
    const Json& smoke = part(json, "smoke");
    fire.smoke_start = number(smoke, "start", fire.smoke_start);
    fire.smoke_spread = number(smoke, "spread", fire.smoke_spread);
    return fire;
}

void read_optics(const Json& optics, FogRecipe& recipe) {
    recipe.extinction = number(optics, "extinction", recipe.extinction);
    recipe.albedo = triple(optics, "albedo", recipe.albedo);
    recipe.g = number(optics, "g", recipe.g);
}

// Constraints that a schema cannot express.
void check_bounds(const FogRecipe& recipe, const std::string& file) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(recipe.bounds.low[axis] < recipe.bounds.high[axis]))
            refuse(file + ": /bounds/high/" + std::to_string(axis), "must be greater than in \"low\"");
    const vec3 size = recipe.bounds.size();
    if (!(recipe.voxel_size <= std::min({size.x, size.y, size.z})))
        refuse(file + ": /voxel_size", "must not exceed the size of the bounds");
    if (!recipe.fire) return;
    if (recipe.fire->edge > recipe.fire->core) refuse(file + ": /fire/edge", "must not exceed \"core\"");
    if (recipe.fire->air > recipe.fire->edge) refuse(file + ": /fire/air", "must not exceed \"edge\"");
    if (recipe.name == temperature_name) refuse(file + ": /name", "is reserved for the grid of the fire's temperature");
}
}

FogRecipe read_recipe(const std::filesystem::path& file) {
    const Json document = parse_json(read_file(file), file.string());
    if (document.has("media") || document.has("gltf"))
        refuse(file.string(), "is a scene, not a fog recipe; a recipe has \"bounds\" and \"voxel_size\"");
    check_schema(document, recipe_schema, file.string());
    FogRecipe recipe;
    recipe.name = document.string_or("name", recipe.name);
    const Json& bounds = part(document, "bounds");
    recipe.bounds = {triple(bounds, "low", recipe.bounds.low), triple(bounds, "high", recipe.bounds.high)};
    recipe.voxel_size = document.number_or("voxel_size", recipe.voxel_size);
    recipe.noise = read_noise(part(document, "noise"), recipe.noise);
    read_density(document, recipe);
    read_motion(document, recipe);
    read_optics(part(document, "optics"), recipe);
    if (const Json* fire = document.find("fire")) recipe.fire = read_fire(*fire);
    check_bounds(recipe, file.string());
    return recipe;
}

std::string recipe_hash(const FogRecipe& recipe) {
    std::string text = "fog recipe " + std::to_string(format_version) + " " + recipe.name;
    const auto add = [&](std::initializer_list<double> values) {
        for (const double value : values) text += formatted(" %a", value);
    };
    const auto add_vector = [&](vec3 v) { add({v.x, v.y, v.z}); };
    add_vector(recipe.bounds.low), add_vector(recipe.bounds.high);
    const auto add_noise = [&](const FractalNoise& noise) {
        add({static_cast<double>(noise.octaves), noise.scale, noise.lacunarity, noise.gain,
             static_cast<double>(noise.seed), noise.evolve, noise.billow ? 1.0 : 0.0});
    };
    add({recipe.voxel_size}), add_noise(recipe.noise);
    add({recipe.threshold, recipe.gain, recipe.soft_edge});
    add_vector(recipe.border);
    add({static_cast<double>(recipe.shape), recipe.shape_strength, recipe.shape_level, recipe.height_base,
         recipe.height_falloff});
    add_vector(recipe.wind);
    add({recipe.swirl, recipe.swirl_scale, recipe.swirl_speed, recipe.period, recipe.extinction});
    add_vector(recipe.albedo);
    add({recipe.g, recipe.frame_rate});
    if (const auto& fire = recipe.fire) {
        text += " fire";
        add_vector(fire->base);
        add({fire->height, fire->radius, fire->taper, fire->core, fire->edge, fire->air, fire->flicker, fire->rise,
             fire->stretch, fire->soot, fire->smoke_start, fire->smoke_spread});
        add_noise(fire->noise);
    }
    return content_hash(text);
}
}
