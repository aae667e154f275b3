#include "scene/file/media_grids.h"

#include "base/error.h"
#include "scene/file/scene_file.h"

#include <algorithm>

namespace tyndall {
namespace {
std::vector<std::string> grid_names(const Field& field, const char* usual) {
    if (!field) return {usual};
    if (field.json->kind == Json::Kind::string) return {field.json->string};
    std::vector<std::string> names;
    for (const Json& name : field.json->items) names.push_back(name.string);
    return names;
}

ValueMap value_map(const Field& field) {
    ValueMap map;
    if (const Field scale = field.member("scale")) map.scale = read_number(scale);
    if (const Field offset = field.member("offset")) map.offset = read_number(offset);
    if (const Field width = field.member("width")) map.width = read_number(width);
    if (const Field clamp = field.member("clamp")) {
        map.clamp = {read_number(clamp.item(0)), read_number(clamp.item(1))};
        if (!(map.clamp.low < map.clamp.high)) refuse(clamp.item(1), "must be greater than the first");
    }
    if (const Field remap = field.member("remap"))
        for (size_t i = 0; i < remap.json->items.size(); ++i) {
            const Field entry = remap.item(i);
            map.table.emplace_back(read_number(entry.item(0)), read_number(entry.item(1)));
            if (i > 0 && !(map.table[i - 1].x < map.table[i].x))
                refuse(entry.item(0), "must be greater than the one before");
        }
    return map;
}

// A property given by a grid's name or an object; from the medium's own file unless the object names another.
GridSource grid_source(const Field& field, const char* usual, const MediumSource& medium, Scene& scene) {
    GridSource source{medium.sequence, {}, {}};
    if (field.json->kind == Json::Kind::string) {
        source.grids = {field.json->string};
        return source;
    }
    source.grids = grid_names(field.member("grid"), usual);
    source.map = value_map(field);
    if (const Field file = field.member("file"))
        with_location(file, [&] {
            const FileSequence other = find_sequence(file.json->string, scene.file.parent_path());
            source.sequence.pattern = other.pattern, source.sequence.files = other.files;
        });
    return source;
}

void read_density(const Field& field, const Field& density, MediumSource& medium, Scene& scene) {
    const GridSource source = grid_source(density, "", medium, scene);
    const std::string own = medium.density_grid;
    if (!source.grids[0].empty() && !own.empty()) refuse(field.member("grid"), "is also given in \"grids\"");
    medium.sequence = source.sequence, medium.density_map = source.map;
    medium.density_grid = source.grids[0].empty() ? own : source.grids[0];
}

VelocitySource velocity_source(const Field& field, const Field& velocity, const MediumSource& medium, Scene& scene) {
    VelocitySource source;
    source.grid = grid_source(velocity, "vel", medium, scene);
    if (const Field unit = field.member("velocity_unit")) source.per_frame = unit.json->string == "frame";
    if (const Field scale = field.member("velocity_scale")) source.scale = read_number(scale);
    if (medium.blends) refuse(velocity, "cannot be combined with the \"blend\" of the sequence; use one of them");
    if (medium.sequence.mode == SequenceMode::ping_pong)
        refuse(velocity, "cannot be used with \"ping_pong\", which plays files backwards");
    return source;
}

BlackbodySource blackbody_source(const Field& field, const MediumSource& medium, Scene& scene) {
    BlackbodySource source;
    const std::string& name = field.member("convention").json->string;
    source.kind = static_cast<BlackbodyKind>(std::ranges::find(blackbody_names, name) - blackbody_names);
    if (const Field scale = field.member("emission_scale")) source.scale = keyed_number(scale);
    if (const Field tint = field.member("tint")) source.tint = keyed_color(tint);
    if (const Field intensity = field.member("intensity")) {
        if (source.kind != BlackbodyKind::cycles) refuse(intensity, "applies only to the convention \"cycles\"");
        source.intensity = read_number(intensity);
    }
    const Field kirchhoff = field.member("kirchhoff");
    if (kirchhoff && source.kind != BlackbodyKind::kelvin)
        refuse(kirchhoff, "applies only to the convention \"kelvin\"");
    source.by_absorption = source.kind == BlackbodyKind::pbrt || (kirchhoff && kirchhoff.json->boolean);
    const bool absorbs = std::ranges::any_of(medium.extinction.values, [](float value) { return value > 0; });
    if (source.by_absorption && !absorbs)
        warn(scene, field.location() + ": emission is proportional to absorption, which is 0 because extinction is 0");
    return source;
}

// A recipe takes its temperature from its fire.
void check_recipe(const Field& field, const Field& blackbody, const FogRecipe& recipe, Scene& scene) {
    if (blackbody && !recipe.fire) refuse(blackbody, "needs a recipe with a \"fire\"");
    if (!blackbody && recipe.fire)
        warn(scene, field.location() + ": its fire gives no light without \"blackbody\": {\"convention\": \"kelvin\"}");
}

// Refuses members that mean nothing without another member.
void check_together(const Field& grids, const Field& blackbody) {
    const Field temperature = grids ? grids.member("temperature") : Field(),
                flame = grids ? grids.member("flame") : Field();
    if (blackbody && !temperature)
        refuse(blackbody, "needs a temperature: \"grids\": {\"temperature\": \"temperature\"}");
    for (const Field& field : {temperature, flame})
        if (field && !blackbody) refuse(field, "has no effect without \"blackbody\"");
}
}

void read_grids(const Field& field, MediumSource& medium, Scene& scene) {
    const Field grids = field.member("grids"), blackbody = field.member("blackbody");
    if (medium.recipe)
        check_recipe(field, blackbody, *medium.recipe, scene);
    else
        check_together(grids, blackbody);
    if (grids) {
        const MediumSource usual = medium; // whose file is the default, even if the density comes from another
        const auto read = [&](const char* name, const char* grid, std::optional<GridSource>& source) {
            if (const Field property = grids.member(name)) source = grid_source(property, grid, usual, scene);
        };
        if (const Field density = grids.member("density")) read_density(field, density, medium, scene);
        read("albedo", "Cd", medium.albedo_grid), read("emission", "emission", medium.emission_grid);
        read("temperature", "temperature", medium.temperature), read("flame", "flame", medium.flame);
        if (const Field velocity = grids.member("velocity"))
            medium.velocity = velocity_source(field, velocity, usual, scene);
    }
    if (!medium.velocity)
        for (const char* name : {"velocity_unit", "velocity_scale"})
            if (const Field said = field.member(name))
                refuse(said, "has no effect without a \"velocity\" in \"grids\"");
    if (medium.emission_grid && !field.member("emission")) medium.emission = vec3(1);
    if (blackbody) medium.blackbody = blackbody_source(blackbody, medium, scene);
}
}
