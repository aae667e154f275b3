#include "trace/fog/grid_property.h"

#include "base/error.h"
#include "base/io/cache_folder.h"
#include "base/io/file.h"
#include "base/text.h"
#include "scene/scene.h"
#include "trace/fog/grid_file.h"
#include "trace/fog/grids.h"
#include "trace/fog/media.h"
#include "trace/fog/motion.h"
#include "volume/bricks/bricks.h"
#include "volume/bricks/half.h"
#include "volume/vdb/vdb.h"

#include <span>

namespace tyndall {
namespace {
// A property as stored in cache files.
struct StoredProperty {
    std::vector<BrickPool> pools; // the channels; for colors, then a mask of voxels that have one
    std::vector<dmat4> places;    // index_to_world of each pool
    std::string note;             // what was repaired when its file was read
};

template<class Visit> void fields(StoredProperty& property, Visit& visit) {
    size_t count = property.pools.size();
    visit(count), visit(property.places), visit(property.note);
    property.pools.resize(count);
    for (BrickPool& pool : property.pools) fields(pool, visit);
}

void add_pool(const SparseVolume& volume, StoredProperty& property) {
    property.pools.push_back(*make_bricks(volume)), property.places.push_back(volume.index_to_world);
}

constexpr std::string_view property_names[] = {"albedo", "emission", "temperature", "flame"};

// What half floats lose of factors on a light source that are tiny in the file's units; empty if nothing to speak of.
std::string lost_text(std::span<const SparseVolume> channels) {
    constexpr float precise = 0x1p-10f; // below, more than the darkest 1/16 of the values lose precision
    float highest = 0;
    for (const SparseVolume& channel : channels) {
        for (const Leaf& leaf : channel.leaves) highest = std::max(highest, std::ranges::max(leaf.values));
        for (const Tile& tile : channel.tiles) highest = std::max(highest, tile.value);
    }
    if (highest == 0 || highest >= precise) return {};
    return formatted("its values, up to %g, are stored as half floats: those below 6e-5 lose precision and those below "
                     "6e-8 are lost; give it a larger \"scale\"",
                     static_cast<double>(highest));
}

StoredProperty read_file(const std::filesystem::path& file, const GridSource& source, size_t number,
                         Quantity quantity) {
    StoredProperty property;
    VdbReadReport report;
    std::string lost;
    if (quantity == Quantity::number) {
        const SparseVolume numbers =
            read_vdb(file, source.grids[0], source.map, largest_half, &report, property_names[number]);
        if (property_names[number] == "flame") lost = lost_text({&numbers, 1});
        within(file.string(), [&] { add_pool(numbers, property); });
    } else {
        const float most = quantity == Quantity::share ? 1 : largest_half;
        const ColorVolume color = read_color_vdb(file, source.grids, source.map, most, &report);
        if (quantity == Quantity::color) lost = lost_text(color.channels);
        within(file.string(), [&] {
            for (const SparseVolume& channel : color.channels) add_pool(channel, property);
            add_pool(color.coverage, property);
        });
    }
    property.note = report.summary();
    if (!lost.empty())
        property.note += (property.note.empty() ? "" : "; ") + std::string(property_names[number]) + ": " + lost;
    return property;
}

GridProperty property_of(StoredProperty stored, std::string key, Quantity quantity) {
    GridProperty property;
    property.key = std::move(key);
    std::vector<PlacedBricks> pools;
    for (size_t i = 0; i < stored.pools.size(); ++i)
        pools.push_back({std::make_shared<const BrickPool>(std::move(stored.pools[i])), stored.places[i]});
    if (quantity != Quantity::number) property.coverage = pools.back(), pools.pop_back();
    for (size_t c = 0; c < 3; ++c) property.channels[c] = pools[pools.size() == 3 ? c : 0];
    return property;
}

// A property, and a text that identifies it in every process; empty without a cache folder.
struct FileProperty {
    GridProperty property;
    std::string content;
};

FileProperty read_frame(const GridSource& source, size_t number, Quantity quantity, int frame,
                        const ReadContext& reading, std::span<const GridProperty> known) {
    Snapshot& snapshot = reading.snapshot;
    const auto file =
        file_at(source.sequence, source.grids, frame, reading.missing, "property", source.text(), snapshot);
    if (!file) return {};
    for (const GridProperty& one : known)
        if (one.key == file->key) return {one, file->content};
    StoredProperty stored = load_or_build<StoredProperty>(
        snapshot.files.get(), "bricks", file->content, [&] { return read_file(file->path, source, number, quantity); });
    if (!stored.note.empty()) snapshot.notes.push_back(file->path.filename().string() + ": " + stored.note);
    return {property_of(std::move(stored), file->key, quantity), file->content};
}

// The property at a time between frames: two files blended, or one moved by velocities.
StoredProperty property_between(const SequenceTime& time, const GridProperty& here, const GridProperty& next,
                                Quantity quantity, const std::string& what) {
    StoredProperty property;
    const auto gray = [](const GridProperty& one) { return one.channels[0].bricks == one.channels[1].bricks; };
    const size_t channels = gray(here) && gray(next) ? 1 : 3;
    for (size_t c = 0; c < channels; ++c) add_pool(volume_at(time, here.channels[c], next.channels[c], what), property);
    if (quantity != Quantity::number) add_pool(volume_at(time, here.coverage, next.coverage, what), property);
    return property;
}
}

GridProperty grid_property(const std::optional<GridSource>& source, size_t number, Quantity quantity,
                           const ReadContext& reading, const GridProperty* before) {
    if (!source) return {};
    const SequenceTime& time = reading.time;
    const FogFrames* frames_before = reading.before ? reading.before->frames.get() : nullptr;
    std::vector<GridProperty> known;
    if (before) known.push_back(*before);
    if (frames_before)
        known.insert(known.end(), frames_before->properties[number].begin(), frames_before->properties[number].end());
    if (!time.between()) return read_frame(*source, number, quantity, time.frame, reading, known).property;

    const auto of_frame = [&](int frame) {
        FileProperty read = read_frame(*source, number, quantity, frame, reading, known);
        if (read.property) reading.frames.properties[number].push_back(read.property);
        return read;
    };
    const FileProperty here = of_frame(time.frame), next = time.share > 0 ? of_frame(time.frame + 1) : FileProperty();
    if (!here.property && !next.property) return {};
    if (time.share > 0 && here.property.key == next.property.key) return here.property;
    const std::string key = here.property.key + "\n" + next.property.key + time.key();
    if (before && before->key == key) return *before;
    CacheFolder* files = reading.snapshot.files.get();
    std::string content;
    if (files) content = "property " + content_hash(here.content + "\n" + next.content + "\n" + time.content());
    const std::string what = moved_name(*reading.snapshot.scene, reading.medium, property_names[number]);
    return property_of(load_or_build<StoredProperty>(
                           files, "bricks", content,
                           [&] { return property_between(time, here.property, next.property, quantity, what); }),
                       key, quantity);
}

GridProperty grown_temperature(const MediumSource& source, const ReadContext& reading, const GridProperty* before) {
    const FogRecipe recipe = medium_recipe(source);
    const double seconds = reading.moment.grown.value_or(reading.moment.seconds);
    GridProperty property;
    property.key = "temperature of " + recipe_key(recipe, seconds);
    if (before && before->key == property.key) return *before;
    StoredProperty stored = load_or_build<StoredProperty>(reading.snapshot.files.get(), "bricks", property.key, [&] {
        StoredProperty made;
        add_pool(generate_temperature(recipe, seconds), made);
        return made;
    });
    property.channels.fill({std::make_shared<const BrickPool>(std::move(stored.pools[0])), stored.places[0]});
    return property;
}
}
