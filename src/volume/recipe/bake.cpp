#include "volume/recipe/bake.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/io/file.h"
#include "base/io/frames.h"
#include "base/parallel.h"
#include "base/text.h"
#include "volume/recipe/growth.h"
#include "volume/recipe/motion.h"

#include <deque>
#include <future>

namespace tyndall {
namespace {
using Metadata = std::vector<std::pair<std::string, std::string>>;

using tyndall::shortest_text;
std::string shortest_text(vec3 v) { return shortest_text(v.x) + " " + shortest_text(v.y) + " " + shortest_text(v.z); }

std::string settings_hash(const FogRecipe& recipe, const BakeOptions& options) {
    const VdbWriteOptions& write = options.write;
    return content_hash(recipe_hash(recipe) + (write.half ? " half" : " float") + (write.blosc ? " blosc " : " zip ") +
                        write.creator + (options.velocity ? " velocity" : ""));
}

Metadata frame_metadata(const FogRecipe& recipe, const std::string& hash, int frame, double seconds) {
    Metadata metadata{{"tyndall_schema", "1"},
                      {"tyndall_frame", std::to_string(frame)},
                      {"tyndall_time_s", shortest_text(seconds)},
                      {"tyndall_fps", shortest_text(recipe.frame_rate)},
                      {"tyndall_up_axis", "Y"},
                      {"tyndall_unit_m", "1"},
                      {"tyndall_extinction_per_m", shortest_text(recipe.extinction)},
                      {"tyndall_albedo", shortest_text(recipe.albedo)},
                      {"tyndall_g", shortest_text(recipe.g)},
                      {"tyndall_seed", std::to_string(recipe.noise.seed)},
                      {"tyndall_settings_hash", hash}};
    // For loops, record the speeds after rounding to whole turns.
    if (recipe.period > 0) {
        const auto speed = [&](double asked) {
            return shortest_text(static_cast<float>(turns_per_loop(recipe, asked) / recipe.period));
        };
        metadata.emplace_back("tyndall_period_s", shortest_text(recipe.period));
        if (recipe.noise.evolve != 0) metadata.emplace_back("tyndall_evolve_per_s", speed(recipe.noise.evolve));
        if (recipe.swirl != 0) metadata.emplace_back("tyndall_swirl_per_s", speed(recipe.swirl_speed));
    }
    return metadata;
}

const std::string* find(const Metadata& metadata, std::string_view key) {
    for (const auto& [name, text] : metadata)
        if (name == key) return &text;
    return nullptr;
}

// True if the file is an intact bake of this frame with these settings.
bool is_right(const std::filesystem::path& file, const std::string& hash, int frame) {
    if (!std::filesystem::exists(file)) return false;
    try {
        const Metadata metadata = vdb_metadata(file);
        const std::string* made_by = find(metadata, "tyndall_settings_hash");
        const std::string* shows = find(metadata, "tyndall_frame");
        if (!made_by || *made_by != hash || !shows) return false;
        double number = 0;
        std::from_chars(shows->data(), shows->data() + shows->size(), number);
        return number == frame && is_as_written(file);
    } catch (const Error&) {
        return false; // truncated or damaged: bake again
    }
}

struct Written {
    std::filesystem::path file;
    int frame = 0;
    uint64_t voxels = 0, bytes = 0;
};

std::vector<VdbGridContent> grids_of(const FogRecipe& recipe, const BakeOptions& options) {
    std::vector<VdbGridContent> grids{{recipe.name}};
    if (recipe.fire) grids.push_back({temperature_name});
    if (options.velocity) grids.push_back({velocity_name, true});
    for (size_t g = 1; g < grids.size(); ++g)
        if (grids[g].name == recipe.name)
            refuse("name", "\"" + recipe.name + "\" is reserved for another grid of this bake");
    return grids;
}

// Fills the velocity components of a leaf from its temperature (null: no fire).
void grow_velocity(const RecipeGrid& growth, const FogMotion& motion, ivec3 origin, const Leaf* kelvin,
                   std::span<Leaf, 3> leaves) {
    std::array<vec3, 512> points, velocity;
    for (int v = 0; v < 512; ++v) {
        const ivec3 at = origin + ivec3(v / 64, v / 8 % 8, v % 8);
        for (int axis = 0; axis < 3; ++axis) points[v][axis] = growth.at[axis][at[axis]];
    }
    constexpr std::array<float, 512> cold{};
    fog_velocity(motion, points, kelvin ? kelvin->values : cold, velocity);
    for (int axis = 0; axis < 3; ++axis) {
        leaves[axis].origin = origin;
        for (int v = 0; v < 512; ++v) leaves[axis].values[v] = velocity[v][axis];
    }
}

VdbImage frame_image(const FogRecipe& recipe, double seconds, Metadata metadata, const BakeOptions& options,
                     const std::string& where) {
    const RecipeGrid growth = make_recipe_grid(recipe, seconds);
    const std::optional<FogMotion> motion =
        options.velocity ? std::optional(fog_motion(recipe, seconds)) : std::nullopt;
    const VdbContent content{.grids = grids_of(recipe, options),
                             .index_to_world = growth.index_to_world,
                             .metadata = std::move(metadata),
                             .tiles = {},
                             .origins = growth.origins,
                             .fill = [&](size_t number, std::span<Leaf> leaves) {
                                 Leaf* const kelvin = recipe.fire ? &leaves[1] : nullptr;
                                 generate_leaf(growth, number, leaves[0], kelvin);
                                 if (motion)
                                     grow_velocity(growth, *motion, growth.origins[number], kelvin, leaves.last<3>());
                             }};
    return {content, options.write, where};
}

// Frames written in the background while the next one is generated; few, to bound memory.
class Writers {
public:
    Writers(BakeReport& report, Progress& progress)
        : report_(report), progress_(progress), max_(static_cast<size_t>(std::clamp(thread_count() / 2, 1, 4))) {}

    void start(std::filesystem::path file, int frame, VdbImage image) {
        while (pending_.size() >= max_) finish_one();
        // With one thread, writing is deferred until the frame is finished.
        const auto when = thread_count() > 1 ? std::launch::async : std::launch::deferred;
        pending_.push_back(std::async(when, [file = std::move(file), frame, image = std::move(image)] {
            image.write(file);
            return Written{file, frame, image.voxels(), check_readable(file)};
        }));
    }
    void keep(const std::filesystem::path& file) {
        ++report_.kept;
        progress_.line(file.filename().string() + ": kept");
        progress_.skip(1);
    }
    void finish() {
        while (!pending_.empty()) finish_one();
    }

private:
    void finish_one() {
        const Written written = pending_.front().get();
        pending_.pop_front();
        ++report_.written;
        report_.voxels += written.voxels, report_.bytes += written.bytes;
        progress_.line(written.file.filename().string() +
                       formatted(": %.2f M voxels with fog, %.2f MB", written.voxels * 1e-6, written.bytes * 1e-6));
        progress_.set(report_.written);
    }

    BakeReport& report_;
    Progress& progress_;
    size_t max_;
    std::deque<std::future<Written>> pending_;
};
}

BakeReport bake(const FogRecipe& recipe, const std::string& pattern, const std::vector<int>& frames,
                const BakeOptions& options, Progress& progress) {
    if (frames.size() > 1 && !has_frame_token(pattern))
        fail(ExitCode::usage, pattern, "several frames need a frame number in the name, such as fog.####.vdb");
    const double start = steady_seconds();
    BakeReport report;
    if (frames.empty()) return report;
    const std::filesystem::path first = frame_name(pattern, frames.front());
    check_output(first);
    sweep_temporaries(first.has_parent_path() ? first.parent_path() : ".");

    const std::string hash = settings_hash(recipe, options);
    Writers writers(report, progress);
    for (const int frame : frames) {
        if (options.cancel && *options.cancel) break;
        const std::filesystem::path file = frame_name(pattern, frame);
        if (options.resume && is_right(file, hash, frame)) {
            writers.keep(file);
            continue;
        }
        const double seconds = frame / recipe.frame_rate;
        writers.start(
            file, frame,
            frame_image(recipe, seconds, frame_metadata(recipe, hash, frame, seconds), options, file.string()));
    }
    writers.finish();
    report.cancelled = report.written + report.kept < static_cast<int>(frames.size());
    report.seconds = steady_seconds() - start;
    return report;
}
}
