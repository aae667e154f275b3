#include "viewer/painting/volume_picture.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "measure/metrics/heatmap.h"
#include "measure/report/grid_report.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
constexpr int max_cells = 256, max_layers = 128; // along an image's side, and in depth
constexpr int lanes = 16;

// The axes of the image for each axis of view: to the right and up.
constexpr std::array<ivec2, 3> axes_across{ivec2(2, 1), ivec2(0, 2), ivec2(0, 1)};

// The shown part of a medium: all of it, or where it is infinite, the extent of the scene.
Box shown_box(const Medium& medium, const Snapshot& snapshot, const Camera& camera) {
    Box box = medium.world_bounds;
    const Box scene = snapshot.bounds;
    for (int axis = 0; axis < 3; ++axis) {
        const bool has_scene = !scene.empty() && std::isfinite(scene.low[axis]) && std::isfinite(scene.high[axis]);
        if (!std::isfinite(box.low[axis])) box.low[axis] = has_scene ? scene.low[axis] : camera.position[axis] - 10;
        if (!std::isfinite(box.high[axis])) box.high[axis] = has_scene ? scene.high[axis] : camera.position[axis] + 10;
        box.high[axis] = std::max(box.high[axis], box.low[axis] + 1e-3f);
    }
    return box;
}

// Cells along an axis of the box: voxels, if the medium has any.
int cells_along(const Medium& medium, const Box& box, int axis, int most) {
    if (medium.density.kind != DensityKind::bricks) return std::min(most, 128);
    const vec3 voxel = medium.density.bricks->voxel_size;
    const float finest = std::min(voxel.x, std::min(voxel.y, voxel.z));
    return std::clamp(static_cast<int>(std::ceil((box.high[axis] - box.low[axis]) / finest)), 1, most);
}

// Density at the cells of one row: in one layer, or the maximum or mean over all layers.
void fill_row(const Medium& medium, const VolumePicture& shown, std::span<const float> layers, int row,
              Image<float>& values) {
    const int axis = shown.question.axis;
    const vec3 low = shown.box.low, size = shown.box.high - shown.box.low;
    float point[3][lanes], density[lanes];
    const float up = 1 - (static_cast<float>(row) + 0.5f) / static_cast<float>(values.size.y);
    for (int first = 0; first < values.size.x; first += lanes) {
        float sum[lanes] = {};
        for (int i = 0; i < lanes; ++i) {
            const float right =
                (static_cast<float>(std::min(first + i, values.size.x - 1)) + 0.5f) / static_cast<float>(values.size.x);
            point[shown.right][i] = low[shown.right] + right * size[shown.right];
            point[shown.up][i] = low[shown.up] + up * size[shown.up];
        }
        for (const float layer : layers) {
            std::fill_n(point[axis], lanes, layer);
            densities(medium, point[0], point[1], point[2], density);
            for (int i = 0; i < lanes; ++i)
                sum[i] =
                    shown.question.look == VolumeLook::maximum ? std::max(sum[i], density[i]) : sum[i] + density[i];
        }
        const float share = shown.question.look == VolumeLook::mean ? 1 / static_cast<float>(layers.size()) : 1;
        for (int i = 0; i < lanes && first + i < values.size.x; ++i) values.at(first + i, row) = share * sum[i];
    }
}

Image<float> density_of(const Medium& medium, VolumePicture& shown) {
    const int axis = shown.question.axis;
    const float low = shown.box.low[axis], size = shown.box.high[axis] - low;
    std::vector<float> layers;
    if (shown.question.look == VolumeLook::slice) {
        layers = {low + shown.question.position * size};
        shown.place = layers[0];
    } else {
        const int count = cells_along(medium, shown.box, axis, max_layers);
        for (int i = 0; i < count; ++i)
            layers.push_back(low + size * (static_cast<float>(i) + 0.5f) / static_cast<float>(count));
    }

    // Square cells, as many along the longer side as allowed.
    const vec2 sides(shown.box.high[shown.right] - shown.box.low[shown.right],
                     shown.box.high[shown.up] - shown.box.low[shown.up]);
    const int longer = sides.x >= sides.y ? 0 : 1;
    const int most = cells_along(medium, shown.box, longer == 0 ? shown.right : shown.up, max_cells);
    const ivec2 cells = glm::max(ivec2(glm::round(static_cast<float>(most) * sides / sides[longer])), ivec2(1));
    Image<float> values(cells);
    parallel_ranges(cells.y, 4, [&](int64_t begin, int64_t end) {
        for (int row = static_cast<int>(begin); row < end; ++row) fill_row(medium, shown, layers, row, values);
    });
    return values;
}

std::vector<std::pair<std::string, std::string>> brick_facts(const BrickPool& bricks) {
    const uint64_t all = static_cast<uint64_t>(bricks.size.x) * bricks.size.y * bricks.size.z;
    const uint64_t stored = bricks.values.size() / brick_stride;
    return {
        {"voxel size", vector_text(bricks.voxel_size) + " m"},
        {"world", vector_text(bricks.bounds.low) + " to " + vector_text(bricks.bounds.high) + " m"},
        {"bricks of 8\u00b3", formatted("%llu of %llu hold fog, %zu constant", static_cast<unsigned long long>(stored),
                                        static_cast<unsigned long long>(all), bricks.constants.size())},
        {"highest density", formatted("%.4g, mean %.3g", double(bricks.highest), double(bricks.mean))},
        {"in memory", bytes_text(static_cast<double>(bricks.bytes()))}};
}

// Facts about the file, as in tyndall info.
std::vector<std::pair<std::string, std::string>> file_facts(const std::filesystem::path& file,
                                                            const std::string& wanted) {
    const VdbInfo info = vdb_info(file);
    std::vector<std::pair<std::string, std::string>> facts{{"file", file.filename().string()}};
    for (const VdbGridInfo& grid : info.grids) {
        if (!wanted.empty() && grid.name != wanted && grid.key != wanted) continue;
        facts.emplace_back("grid", printable(grid.key, 80) + ": " + kind_text(grid));
        for (auto& row : grid_rows(grid)) facts.push_back(std::move(row));
        if (grid.usable) // the only tree configuration that can be read
            facts.emplace_back("tree", "4 levels: root, nodes of 32\u00b3 and 16\u00b3, leaves of 8\u00b3");
    }
    return facts;
}

std::vector<std::pair<std::string, std::string>> facts_of(const Scene& scene, const Medium& medium,
                                                          const Request& request, KnownVolumes& known) {
    const auto source = std::ranges::find(scene.media, medium.name, &MediumSource::name);
    std::vector<std::pair<std::string, std::string>> facts;
    if (source != scene.media.end() && source->kind == MediumKind::vdb && !request.moving)
        if (const auto file = sequence_file(source->sequence, request.frame, request.missing)) {
            const auto written = std::filesystem::last_write_time(*file).time_since_epoch().count();
            const std::string key = file->string() + " " + std::to_string(written) + " " + source->density_grid;
            if (known.key != key) known = {key, file_facts(*file, source->density_grid)};
            facts = known.facts;
        }
    if (medium.density.kind == DensityKind::bricks) {
        facts.emplace_back("as rendered", source != scene.media.end() && source->kind == MediumKind::noise
                                              ? "grown from a recipe"
                                              : "read as fog");
        for (auto& row : brick_facts(*medium.density.bricks)) facts.push_back(std::move(row));
    } else {
        facts.emplace_back("kind",
                           medium.density.kind == DensityKind::height
                               ? formatted("falls with height: to 37 %% in %.3g m above %.3g m",
                                           double(medium.density.height_falloff), double(medium.density.height_base))
                               : "homogeneous");
    }
    facts.emplace_back("extinction", formatted("%.4g 1/m at density 1", double(gray_extinction(medium.optics))));
    return facts;
}
}

std::shared_ptr<const VolumePicture> volume_picture(const Request& request, const Snapshot& snapshot,
                                                    KnownVolumes& known) {
    auto shown = std::make_shared<VolumePicture>();
    shown->revision = request.revision, shown->question = *request.volume, shown->frame = request.frame;
    shown->quick = request.moving;
    const std::string& wanted = request.volume->medium;
    const auto medium =
        wanted.empty() ? snapshot.media.begin() : std::ranges::find(snapshot.media, wanted, &Medium::name);
    if (medium == snapshot.media.end()) {
        shown->remark = wanted.empty() ? "there is no fog at this moment" : wanted + " has no fog at this moment";
        return shown;
    }
    shown->medium = medium->name, shown->extinction = gray_extinction(medium->optics);
    shown->right = axes_across[static_cast<size_t>(request.volume->axis)].x;
    shown->up = axes_across[static_cast<size_t>(request.volume->axis)].y;
    shown->box = shown_box(*medium, snapshot, request.camera);
    shown->facts = facts_of(*request.scene, *medium, request, known);

    const Image<float> values = density_of(*medium, *shown);
    shown->high = medium->density.kind == DensityKind::bricks ? medium->density.bricks->highest : 1.0;
    if (request.volume->look == VolumeLook::mean) shown->high = *std::ranges::max_element(values.pixels);
    if (!(shown->high > 0)) shown->high = 1;
    shown->codes = Image<glm::u8vec4>(values.size);
    for (size_t i = 0; i < values.pixels.size(); ++i)
        shown->codes.pixels[i] = {heat_color(values.pixels[i] / shown->high), 255};
    return shown;
}
}
