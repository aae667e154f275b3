// Builds a scene's media at one moment: evaluates optics, reads files, generates fog from recipes, applies transforms.
#include "trace/fog/media.h"
#include "base/error.h"
#include "base/io/cache_folder.h"
#include "base/io/file.h"
#include "base/text.h"
#include "scene/scene.h"
#include "trace/fog/density_unit.h"
#include "trace/fog/grid_file.h"
#include "trace/fog/grids.h"
#include "trace/fog/motion.h"
#include "volume/bricks/bricks.h"
#include "volume/bricks/half.h"
#include "volume/medium.h"
#include "volume/vdb/vdb.h"

#include <algorithm>
#include <span>

namespace tyndall {
float recipe_speed(const FogRecipe& recipe) {
    const auto speed = [](float advection, const FractalNoise& noise) {
        return advection + std::abs(noise.evolve) * noise.scale;
    };
    const float smoke = speed(glm::length(recipe.wind), recipe.noise);
    const float flames = recipe.fire ? speed(recipe.fire->rise, recipe.fire->noise) : 0;
    return std::max(smoke, flames) + 2 * pi * std::abs(recipe.swirl * recipe.swirl_speed);
}

FogRecipe medium_recipe(const MediumSource& source) {
    FogRecipe recipe = *source.recipe;
    if (source.voxel_size > 0) recipe.voxel_size = source.voxel_size;
    return recipe;
}

std::string recipe_key(const FogRecipe& recipe, double seconds) {
    std::string key = "recipe " + recipe_hash(recipe);
    if (recipe_speed(recipe) > 0) key += formatted(" at %a", seconds);
    return key;
}

namespace {
mat4 checked_matrix(const Scene& scene, const MediumSource& source, double seconds) {
    const mat4 matrix = medium_matrix(source, seconds);
    const float determinant = glm::determinant(mat3(matrix));
    if (!std::isfinite(determinant) || determinant == 0)
        refuse(scene.file.string(), named("medium", source.name) + ": its transform is singular or out of range");
    return matrix;
}

Optics optics_at(const MediumSource& source, const Moment& moment) {
    const double seconds = moment.seconds;
    const float extinction = source.extinction.at(seconds);
    Optics optics{vec3(extinction), source.albedo.at(seconds), phase_at(source.phase, source.g.at(seconds), seconds),
                  mean_brightness(moment, [&](double time) { return source.emission.at(time); })};
    if (source.channel_extinction && extinction > 0)
        optics.channels = glm::max(source.channel_extinction->at(seconds) / extinction, min_extinction);
    return optics;
}

// Fog as stored in cache files.
struct StoredFog {
    bool any = false;        // false = no fog, and no bricks
    dmat4 index_to_world{1}; // before the medium's transform
    BrickPool bricks;
    float unit = 1;   // as in FogSource
    std::string note; // what was repaired when its file was read
};

template<class Visit> void fields(StoredFog& fog, Visit& visit) {
    visit(fog.any), visit(fog.index_to_world), fields(fog.bricks, visit), visit(fog.unit), visit(fog.note);
}

StoredFog stored_fog(const SparseVolume& volume, float unit, std::string note) {
    StoredFog fog{!volume.empty(), volume.index_to_world, {}, unit, std::move(note)};
    if (fog.any) fog.bricks = *make_bricks(volume);
    return fog;
}

FogSource source_of(StoredFog fog, std::string key, const std::string& content) {
    FogSource source;
    source.key = std::move(key);
    source.index_to_world = fog.index_to_world, source.unit = fog.unit;
    if (!fog.any) return source;
    fog.bricks.content = content;
    source.bricks = std::make_shared<const BrickPool>(std::move(fog.bricks));
    return source;
}

FogSource grown(const MediumSource& source, double seconds, CacheFolder* files, const FogSource& before) {
    const FogRecipe recipe = medium_recipe(source);
    const std::string key = recipe_key(recipe, seconds);
    if (key == before.key) return before;
    const auto grow_fog = [&] { return stored_fog(generate(recipe, seconds), 1, {}); };
    return source_of(load_or_build<StoredFog>(files, "bricks", key, grow_fog), key, files ? key : "");
}

// The fog in a frame's file, taken from `known` if it is there.
FogSource read(const MediumSource& source, int frame, MissingFrame missing, std::span<const FogSource> known,
               Snapshot& snapshot) {
    const auto file = file_at(source.sequence, density_grids(source), frame, missing, "file",
                              source.density_grid + source.density_map.text(), snapshot);
    if (!file) return {};
    for (const FogSource& one : known)
        if (one.key == file->key) return one;
    const StoredFog fog = load_or_build<StoredFog>(snapshot.files.get(), "bricks", file->content, [&] {
        VdbReadReport report;
        SparseVolume volume = read_vdb(file->path, source.density_grid, source.density_map, infinity, &report);
        const float unit = density_unit(volume);
        report.above = divide_by(unit, volume), report.most = unit * largest_half;
        return within(file->path.string(), [&] { return stored_fog(volume, unit, report.summary()); });
    });
    if (!fog.note.empty()) snapshot.notes.push_back(file->path.filename().string() + ": " + fog.note);
    return source_of(fog, file->key, file->content);
}

std::string content_of(const FogSource& source) { return source.bricks ? source.bricks->content : "none"; }

// Fog at a time between frames: two files blended, or one moved by its velocities. Stores the files read in `frames`.
FogSource read_between(const MediumSource& source, const SequenceTime& time, MissingFrame missing,
                       const FogSource& before, std::span<const FogSource> known, FogFrames& frames,
                       Snapshot& snapshot) {
    const auto of_frame = [&](int frame) {
        FogSource fog = read(source, frame, missing, known, snapshot);
        fog.placed = nullptr, fog.grids = nullptr;
        frames.densities.push_back(fog);
        return fog;
    };
    const FogSource here = of_frame(time.frame), next = time.share > 0 ? of_frame(time.frame + 1) : FogSource();
    if (!here.bricks && !next.bricks) return {};
    if (time.share > 0 && here.key == next.key) return here;
    const std::string key = here.key + "\n" + next.key + time.key();
    if (key == before.key) return before;
    std::string content;
    if (snapshot.files)
        content = "file " + content_hash(content_of(here) + "\n" + content_of(next) + "\n" + time.content());
    const StoredFog fog = load_or_build<StoredFog>(snapshot.files.get(), "bricks", content, [&] {
        const SparseVolume volume = volume_at(time, {here.bricks, here.index_to_world, here.unit},
                                              {next.bricks, next.index_to_world, next.unit},
                                              moved_name(*snapshot.scene, source.name, "density"));
        return stored_fog(volume, here.bricks ? here.unit : next.unit, {});
    });
    return source_of(fog, key, content);
}

// The bricks with the medium's transform applied; shares the densities.
std::shared_ptr<const BrickPool> placed_bricks(const FogSource& source, const mat4& matrix) {
    if (matrix == mat4(1)) return source.bricks;
    auto moved = std::make_shared<BrickPool>(*source.bricks);
    place(*moved, dmat4(matrix) * source.index_to_world);
    if (!moved->content.empty())
        moved->content += " moved " + content_hash({reinterpret_cast<const char*>(&matrix), sizeof matrix});
    return moved;
}

// A medium's files at a moment, and those of the previous moment.
struct MovingFiles {
    SequenceTime time;
    const FogFrames* before = nullptr;
    FogFrames now;
};

FogSource fog_source(const Scene& scene, const MediumSource& source, Moment moment, MissingFrame missing,
                     const FogSource& before, MovingFiles& files, Snapshot& snapshot) {
    std::vector<FogSource> known{before};
    if (files.before) known.insert(known.end(), files.before->densities.begin(), files.before->densities.end());
    FogSource result;
    if (source.kind == MediumKind::noise)
        result = grown(source, moment.grown.value_or(moment.seconds), snapshot.files.get(), before);
    else if (files.time.between())
        result = read_between(source, files.time, missing, before, known, files.now, snapshot);
    else
        result = read(source, files.time.frame, missing, known, snapshot);
    const mat4 matrix = checked_matrix(scene, source, moment.seconds);
    if (!result.bricks || (result.placed && result.matrix == matrix)) return result;
    result.placed = placed_bricks(result, matrix);
    result.matrix = matrix;
    return result;
}

// Analytic fog: the medium's transform moves its box, not its height falloff.
void add_analytic(const Scene& scene, const MediumSource& source, double seconds, Medium& medium) {
    const mat4 matrix = checked_matrix(scene, source, seconds);
    medium.density.kind = source.kind == MediumKind::height ? DensityKind::height : DensityKind::homogeneous;
    medium.density.bounds = source.bounds;
    medium.density.world_to_local = glm::inverse(matrix);
    medium.world_bounds = transform_box(matrix, source.bounds);
    medium.density.height_base = source.height_base.at(seconds),
    medium.density.height_falloff = source.height_falloff.at(seconds);
}

// Sets a medium's density and bounds. Returns false if it has no fog at this moment.
bool find_fog(const Scene& scene, const MediumSource& source, Moment moment, MissingFrame missing,
              const FogSource& before, MovingFiles& files, Snapshot& snapshot, Medium& medium) {
    if (source.kind != MediumKind::noise && source.kind != MediumKind::vdb) {
        add_analytic(scene, source, moment.seconds, medium);
        return true;
    }
    FogSource& fog = snapshot.fog_sources.back();
    fog = fog_source(scene, source, moment, missing, before, files, snapshot);
    if (!fog.placed || !(fog.placed->highest > 0)) return false;
    medium.density.kind = DensityKind::bricks;
    medium.density.bricks = fog.placed;
    medium.world_bounds = fog.placed->bounds;
    return true;
}

void add_medium(const Scene& scene, const MediumSource& source, Moment moment, MissingFrame missing,
                const FogSource& before, Snapshot& snapshot) {
    FogSource& fog = snapshot.fog_sources.emplace_back(before);
    Medium medium;
    medium.name = source.name;
    medium.optics = optics_at(source, moment);
    if (source.emission_grid) medium.optics.emission.radiance = vec3(0);
    const bool dims = gray_extinction(medium.optics) > 0;
    MovingFiles files;
    files.before = before.grids ? before.grids->frames.get() : nullptr;
    files.time = sequence_time(scene, source, moment, missing, files.before, snapshot);
    files.now.velocity = files.time.velocity || !files.before ? files.time.velocity : files.before->velocity;
    files.now.frame = files.time.frame, files.now.moved = files.time.moved;
    const bool fog_is_there = (dims || max_component(medium.optics.emission.radiance) > 0) &&
                              find_fog(scene, source, moment, missing, before, files, snapshot, medium);
    fog.grids = nullptr;
    if (has_grids(source)) {
        const mat4 matrix = checked_matrix(scene, source, moment.seconds);
        fog.grids = medium_grids(source, moment, files.time, missing, matrix, dims ? fog : FogSource(),
                                 before.grids.get(), files.now, snapshot);
    }
    if (moves(source)) {
        auto grids = fog.grids ? std::make_shared<MediumGrids>(*fog.grids) : std::make_shared<MediumGrids>();
        grids->frames = std::make_shared<const FogFrames>(std::move(files.now));
        fog.grids = std::move(grids);
    }
    if (fog_is_there) {
        medium.optics.extinction *= fog.unit, medium.optics.emission.radiance *= fog.unit;
        if (!dims) medium.optics.extinction = vec3(min_extinction);
        if (!dims && !is_finite(medium.world_bounds.size()))
            refuse(scene.file.string(),
                   named("medium", source.name) + ": emits in unbounded space; give it bounds or an extinction");
        if (fog.grids) color_medium(source, moment.seconds, *fog.grids, medium);
        snapshot.media.push_back(std::move(medium));
    }
    if (fog.grids) append_light(source, moment, *fog.grids, fog.unit, snapshot);
}
}

void add_media(const Scene& scene, Moment moment, const Snapshot* previous, MissingFrame missing, Snapshot& snapshot) {
    const bool comparable = previous && previous->fog_sources.size() == scene.media.size();
    snapshot.fog_sources.reserve(scene.media.size());
    for (size_t i = 0; i < scene.media.size(); ++i)
        add_medium(scene, scene.media[i], moment, missing, comparable ? previous->fog_sources[i] : FogSource{},
                   snapshot);
}
}
