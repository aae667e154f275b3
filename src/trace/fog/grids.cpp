#include "trace/fog/grids.h"

#include "base/text.h"
#include "scene/scene.h"
#include "trace/fog/media.h"
#include "trace/fog/motion.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <map>

namespace tyndall {
namespace {
std::array<std::shared_ptr<const BrickPool>, 3> bricks_of(const GridProperty& property) {
    return {property.channels[0].bricks, property.channels[1].bricks, property.channels[2].bricks};
}

// Key of everything derived from the properties before the medium's transform.
std::string key_of(const MediumSource& source, double seconds, const MediumGrids& grids, const FogSource& fog) {
    std::string key;
    for (const GridProperty* property : {&grids.albedo, &grids.emission, &grids.temperature, &grids.flame})
        key += property->key + "\n";
    key += fog.key;
    if (!source.blackbody) return key;
    key += formatted("\n%d %d %a", static_cast<int>(source.blackbody->kind), source.blackbody->by_absorption,
                     static_cast<double>(source.blackbody->intensity));
    const vec3 albedo = source.albedo.at(seconds);
    if (source.blackbody->by_absorption)
        for (int c = 0; c < 3; ++c) key += formatted(" %a", static_cast<double>(albedo[c]));
    return key;
}

EmissionPart part_of(EmissionField field, const dmat4& place, const std::string& name) {
    const LuminanceBricks light = luminance_bricks(field, place, name);
    if (!light.bricks) return {};
    field.spread = light.spread, field.out_of_gamut = light.out_of_gamut;
    return {std::make_shared<const EmissionField>(std::move(field)), {light.bricks, place}, light.radiance};
}

EmissionPart blackbody_part(const MediumSource& source, double seconds, const MediumGrids& grids,
                            const FogSource& fog) {
    const BlackbodySource& blackbody = *source.blackbody;
    if (!grids.temperature || (blackbody.by_absorption && !fog.bricks)) return {};
    if (source.flame && !grids.flame) return {};
    EmissionField field;
    field.table = blackbody_table(blackbody.kind, blackbody.intensity);
    field.source = bricks_of(grids.temperature);
    field.strength = grids.flame.channels[0].bricks;
    if (blackbody.by_absorption) {
        field.absorber = fog.bricks;
        if (grids.color) field.albedo = grids.color, field.base_albedo = source.albedo.at(seconds);
    }
    return part_of(std::move(field), grids.temperature.channels[0].index_to_world, source.name);
}

EmissionPart colored_part(const MediumSource& source, const MediumGrids& grids) {
    if (!grids.emission) return {};
    EmissionField field;
    field.source = bricks_of(grids.emission);
    return part_of(std::move(field), grids.emission.channels[0].index_to_world, source.name);
}

// Applies the medium's transform to brick pools, once to each.
class Placement {
public:
    explicit Placement(const mat4& matrix) : matrix_(matrix) {}
    void add(const PlacedBricks& pool) {
        if (pool.bricks) places_.emplace(pool.bricks.get(), pool.index_to_world);
    }
    void add(const std::shared_ptr<const BrickPool>& pool, const std::shared_ptr<const BrickPool>& placed) {
        moved_[pool.get()] = placed;
    }
    std::shared_ptr<const BrickPool> operator()(const std::shared_ptr<const BrickPool>& pool) {
        if (!pool || matrix_ == mat4(1)) return pool;
        std::shared_ptr<const BrickPool>& moved = moved_[pool.get()];
        if (moved) return moved;
        auto copy = std::make_shared<BrickPool>(*pool);
        place(*copy, dmat4(matrix_) * places_.at(pool.get()));
        return moved = copy;
    }
    std::shared_ptr<const AlbedoField> operator()(const std::shared_ptr<const AlbedoField>& field) {
        if (!field || matrix_ == mat4(1)) return field;
        if (color_) return color_;
        auto copy = std::make_shared<AlbedoField>(*field);
        for (auto& pool : copy->color) pool = (*this)(pool);
        copy->coverage = (*this)(copy->coverage);
        return color_ = copy;
    }
    EmissionPart operator()(const EmissionPart& part) {
        if (!part.field || matrix_ == mat4(1)) return part;
        auto copy = std::make_shared<EmissionField>(*part.field);
        for (auto& pool : copy->source) pool = (*this)(pool);
        copy->strength = (*this)(copy->strength), copy->absorber = (*this)(copy->absorber);
        copy->albedo = (*this)(copy->albedo);
        add(part.luminance);
        return {copy, {(*this)(part.luminance.bricks), part.luminance.index_to_world}, part.radiance};
    }

private:
    mat4 matrix_;
    std::map<const BrickPool*, dmat4> places_;
    std::map<const BrickPool*, std::shared_ptr<const BrickPool>> moved_;
    std::shared_ptr<const AlbedoField> color_;
};

void place_grids(const mat4& matrix, const FogSource& fog, MediumGrids& grids) {
    Placement placement(matrix);
    for (const GridProperty* property : {&grids.albedo, &grids.emission, &grids.temperature, &grids.flame}) {
        for (const PlacedBricks& channel : property->channels) placement.add(channel);
        placement.add(property->coverage);
    }
    if (fog.placed)
        placement.add(fog.bricks, fog.placed);
    else
        placement.add({fog.bricks, fog.index_to_world});
    grids.placed_color = placement(grids.color);
    grids.placed_blackbody = placement(grids.blackbody), grids.placed_colored = placement(grids.colored);
    grids.matrix = matrix, grids.is_placed = true;
}

void append_part(const EmissionPart& part, const std::string& name, vec3 scale, Snapshot& snapshot) {
    if (!part.field || !(max_component(scale) > 0)) return;
    Medium medium;
    medium.name = name;
    medium.optics.extinction = vec3(min_extinction), medium.optics.albedo = vec3(0);
    medium.optics.emission = {part.radiance * scale, part.field, scale};
    medium.density.kind = DensityKind::bricks, medium.density.bricks = part.luminance.bricks;
    medium.world_bounds = part.luminance.bricks->bounds;
    snapshot.media.push_back(std::move(medium));
}
}

bool has_grids(const MediumSource& source) {
    const bool has_temperature = source.temperature || (source.recipe && source.recipe->fire);
    return source.albedo_grid || source.emission_grid || (source.blackbody && has_temperature);
}

namespace {
// The grids of `before` (may be null) that its light in a frame comes from; null if it has none.
const MediumGrids* light_before(const MediumGrids* before, int frame) {
    if (!before || before->blended.empty()) return before;
    const auto found = std::ranges::find(before->blended, frame, &BlendedLight::frame);
    return found == before->blended.end() ? nullptr : found->grids.get();
}

void read_light(const MediumSource& source, const ReadContext& reading, const MediumGrids* before, MediumGrids& grids) {
    const auto known = [&](GridProperty MediumGrids::*property) { return before ? &(before->*property) : nullptr; };
    grids.emission = grid_property(source.emission_grid, 1, Quantity::color, reading, known(&MediumGrids::emission));
    const GridProperty* const temperature = known(&MediumGrids::temperature);
    grids.temperature = source.recipe ? grown_temperature(source, reading, temperature)
                                      : grid_property(source.temperature, 2, Quantity::number, reading, temperature);
    grids.flame = grid_property(source.flame, 3, Quantity::number, reading, known(&MediumGrids::flame));
}

// Each file's own, with the density in `frames` of the fog that absorbs.
std::vector<BlendedLight> blended_light(const MediumSource& source, Moment moment, const SequenceTime& time,
                                        MissingFrame missing, const mat4& matrix, const MediumGrids* before,
                                        FogFrames& frames, Snapshot& snapshot) {
    std::vector<BlendedLight> lights{{time.frame, 1 - time.share, 1, {}}, {time.frame + 1, time.share, 1, {}}};
    for (size_t i = 0; i < lights.size(); ++i) {
        BlendedLight& light = lights[i];
        const FogSource fog = i < frames.densities.size() ? frames.densities[i] : FogSource();
        light.unit = fog.unit;
        SequenceTime own;
        own.frame = light.frame;
        light.grids = medium_grids(source, moment, own, missing, matrix, fog, light_before(before, light.frame), frames,
                                   snapshot);
    }
    return lights;
}
}

std::shared_ptr<const MediumGrids> medium_grids(const MediumSource& source, Moment moment, const SequenceTime& time,
                                                MissingFrame missing, const mat4& matrix, const FogSource& fog,
                                                const MediumGrids* before, FogFrames& frames, Snapshot& snapshot) {
    const ReadContext reading{source.name, moment, time, missing, before, frames, snapshot};
    auto grids = std::make_shared<MediumGrids>();
    grids->albedo = grid_property(source.albedo_grid, 0, Quantity::share, reading, before ? &before->albedo : nullptr);
    std::vector<BlendedLight> blended;
    if (time.share > 0 && (source.emission_grid || source.blackbody))
        blended = blended_light(source, moment, time, missing, matrix, before, frames, snapshot);
    else
        read_light(source, reading, light_before(before, time.frame), *grids);
    grids->key = key_of(source, moment.seconds, *grids, fog);
    const bool same = before && before->key == grids->key;
    if (same) *grids = *before;
    grids->blended = std::move(blended);
    if (same) {
        if (grids->is_placed && grids->matrix == matrix) return grids;
    } else {
        if (grids->albedo) {
            AlbedoField color{bricks_of(grids->albedo), grids->albedo.coverage.bricks};
            const MeanFactor mean = mean_factor(color, {fog.bricks, fog.index_to_world});
            color.spread = mean.spread, grids->mean_factor = mean.mean;
            grids->color = std::make_shared<const AlbedoField>(std::move(color));
        }
        if (source.blackbody) grids->blackbody = blackbody_part(source, moment.seconds, *grids, fog);
        grids->colored = colored_part(source, *grids);
    }
    place_grids(matrix, fog, *grids);
    return grids;
}

void color_medium(const MediumSource& source, double seconds, const MediumGrids& grids, Medium& medium) {
    if (!grids.placed_color) return;
    medium.optics.base_albedo = source.albedo.at(seconds);
    medium.optics.albedo = medium.optics.base_albedo * grids.mean_factor;
    medium.optics.albedo_field = grids.placed_color;
}

namespace {
// A share of the light of grids of one file.
void append_own_light(const MediumSource& source, const Moment& moment, const MediumGrids& grids, float unit,
                      float share, Snapshot& snapshot) {
    const double seconds = moment.seconds;
    if (source.blackbody) {
        const BlackbodySource& blackbody = *source.blackbody;
        vec3 scale =
            mean_brightness(moment, [&](double time) { return blackbody.scale.at(time) * blackbody.tint.at(time); });
        if (blackbody.by_absorption) {
            scale *= unit;
            scale *= source.channel_extinction ? source.channel_extinction->at(seconds)
                                               : vec3(source.extinction.at(seconds));
            const EmissionField* field = grids.placed_blackbody.field.get();
            if (field && !field->albedo) scale *= 1.0f - source.albedo.at(seconds);
        }
        append_part(grids.placed_blackbody, source.name + " (blackbody)", share * scale, snapshot);
    }
    const vec3 scale = mean_brightness(moment, [&](double time) { return source.emission.at(time); });
    append_part(grids.placed_colored, source.name + " (emission)", share * scale, snapshot);
}
}

void append_light(const MediumSource& source, const Moment& moment, const MediumGrids& grids, float unit,
                  Snapshot& snapshot) {
    append_own_light(source, moment, grids, unit, 1, snapshot);
    for (const BlendedLight& light : grids.blended)
        append_own_light(source, moment, *light.grids, light.unit, light.share, snapshot);
}
}
