// Sampling tables of environment maps: means of the bilinear map over each cell, so that no light is missed.
#include "trace/lights/environment.h"

#include "base/error.h"
#include "base/image.h"
#include "base/text.h"
#include "scene/scene.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int max_cells = 2048; // across; larger maps are sampled in blocks of texels
constexpr int gradient_rows = 256;

double row_edge(const DirectionTable& table, int cell_row) {
    const int texel = std::min(cell_row * table.factor, table.texels.y);
    return std::cos(std::numbers::pi * texel / table.texels.y);
}

double column_edge(const DirectionTable& table, int cell_column) {
    return static_cast<double>(std::min(cell_column * table.factor, table.texels.x)) / table.texels.x;
}

// The bilinear image averaged over one texel: weights 1/8, 3/4, 1/8 along each axis.
vec3 mean_in_texel(const Image<vec3>& image, int x, int y) {
    const int columns[] = {(x + image.size.x - 1) % image.size.x, x, (x + 1) % image.size.x};
    const int rows[] = {std::max(y - 1, 0), y, std::min(y + 1, image.size.y - 1)};
    constexpr float weights[] = {0.125f, 0.75f, 0.125f};
    vec3 sum(0);
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) sum += weights[i] * weights[j] * image.at(columns[i], rows[j]);
    return sum;
}

// The map without its intensity, over one texel of the table.
vec3 mean_in_texel(const BackgroundState& map, const DirectionTable& table, int x, int y) {
    if (map.kind == BackgroundKind::image) return mean_in_texel(*map.image, x, y);
    const double high = std::cos(std::numbers::pi * y / table.texels.y),
                 low = std::cos(std::numbers::pi * (y + 1) / table.texels.y);
    BackgroundState plain = map;
    plain.intensity = 1;
    return background_radiance(plain, vec3(0, 0.5 * (high + low), 0), vec2(0));
}

DirectionTable empty_table(const BackgroundState& map) {
    DirectionTable table;
    if (map.kind == BackgroundKind::image) table.texels = map.image->size;
    if (map.kind == BackgroundKind::sky) table.texels = {1, gradient_rows};
    table.factor = (std::max(table.texels.x, table.texels.y) + max_cells - 1) / max_cells;
    table.cells = (table.texels + table.factor - 1) / table.factor;
    return table;
}

// Cumulative probabilities, and the pdfs of cells from their power.
void add_probabilities(const std::vector<double>& powers, double total, DirectionTable& table) {
    table.rows.push_back(0);
    for (int y = 0; y < table.cells.y; ++y) {
        const double* row = &powers[static_cast<size_t>(y) * table.cells.x];
        double sum = 0;
        for (int x = 0; x < table.cells.x; ++x) table.columns.push_back(sum), sum += row[x];
        table.columns.push_back(sum);
        for (int x = 0; x <= table.cells.x && sum > 0; ++x) table.columns.end()[x - table.cells.x - 1] /= sum;
        table.rows.push_back(table.rows.back() + sum / total);
        for (int x = 0; x < table.cells.x; ++x) {
            const double width = 2 * std::numbers::pi * (column_edge(table, x + 1) - column_edge(table, x));
            table.pdfs.push_back(
                static_cast<float>(row[x] / (total * width * (row_edge(table, y) - row_edge(table, y + 1)))));
        }
    }
    for (double& sum : table.rows) sum /= table.rows.back();
}

std::shared_ptr<const DirectionTable> make_table(const BackgroundState& map) {
    DirectionTable table = empty_table(map);
    std::vector<double> powers(static_cast<size_t>(table.cells.x) * table.cells.y);
    dvec3 sum(0);
    double total = 0;
    for (int y = 0; y < table.texels.y; ++y) {
        const double angle =
            2 * std::numbers::pi / table.texels.x *
            (std::cos(std::numbers::pi * y / table.texels.y) - std::cos(std::numbers::pi * (y + 1) / table.texels.y));
        for (int x = 0; x < table.texels.x; ++x) {
            const dvec3 light = angle * dvec3(mean_in_texel(map, table, x, y));
            const double power = std::max(double(luminance(vec3(light))), 0.0);
            powers[static_cast<size_t>(y / table.factor) * table.cells.x + x / table.factor] += power;
            sum += light, total += power;
        }
    }
    table.mean = vec3(sum / (4 * std::numbers::pi));
    if (!(total > 0)) return nullptr;
    add_probabilities(powers, total, table);
    return std::make_shared<const DirectionTable>(std::move(table));
}

// The interval of a cumulative distribution that a number falls in, and its relative position there.
struct CdfSample {
    int index = 0;
    double share = 0;
};
CdfSample sample_cdf(const double* cumulative, int count, double u) {
    const double* next = std::upper_bound(cumulative + 1, cumulative + count, u);
    const double low = next[-1], width = next[0] - low;
    return {static_cast<int>(next - cumulative) - 1, width > 0 ? std::clamp((u - low) / width, 0.0, 1.0) : 0.5};
}
}

std::shared_ptr<const Environment> make_environment(BackgroundState map, const Environment* previous) {
    auto environment = std::make_shared<Environment>();
    if (map.kind == BackgroundKind::image && (!map.image || map.image->empty())) return nullptr;
    if (!(map.intensity > 0)) return nullptr;
    const bool same = previous && map.kind == BackgroundKind::image && previous->map.image == map.image;
    environment->table = same ? previous->table : make_table(map);
    environment->map = std::move(map);
    return environment->table ? environment : nullptr;
}

vec3 environment_radiance(const Environment& environment, vec3 direction) {
    return background_radiance(environment.map, direction, vec2(0)) * environment.scale;
}

EnvironmentSample sample_environment(const Environment& environment, vec2 u) {
    const DirectionTable& table = *environment.table;
    const CdfSample row = sample_cdf(table.rows.data(), table.cells.y, u.x);
    const double* columns = &table.columns[static_cast<size_t>(row.index) * (table.cells.x + 1)];
    const CdfSample column = sample_cdf(columns, table.cells.x, u.y);
    const double height =
        row_edge(table, row.index) + row.share * (row_edge(table, row.index + 1) - row_edge(table, row.index));
    const double left = column_edge(table, column.index), right = column_edge(table, column.index + 1);
    const double turn = 2 * std::numbers::pi * (left + column.share * (right - left) - 0.5) - environment.map.rotation;
    const double across = std::sqrt(std::max(1 - height * height, 0.0));
    EnvironmentSample sample;
    sample.direction = glm::normalize(vec3(across * std::sin(turn), height, -across * std::cos(turn)));
    sample.radiance = environment_radiance(environment, sample.direction);
    sample.pdf = table.pdfs[static_cast<size_t>(row.index) * table.cells.x + column.index];
    return sample;
}

float environment_pdf(const Environment& environment, vec3 direction) {
    const DirectionTable& table = *environment.table;
    const vec2 uv = lat_long_position(direction, environment.map.rotation);
    const ivec2 texel = glm::clamp(ivec2(uv * vec2(table.texels)), ivec2(0), table.texels - 1);
    const ivec2 cell = texel / table.factor;
    return table.pdfs[static_cast<size_t>(cell.y) * table.cells.x + cell.x];
}

std::shared_ptr<const Environment> environment_at(const Scene& scene, const Moment& moment, ivec2 links,
                                                  const Environment* previous) {
    if (!scene.environment) return nullptr;
    const EnvironmentSource& source = *scene.environment;
    const auto made = make_environment(background_at(source.map, moment), previous);
    if (!made) return nullptr;
    auto environment = std::make_shared<Environment>(*made);
    environment->name = source.name;
    const auto scale = [&](double seconds) {
        return source.intensity.at(seconds) * std::exp2(source.exposure.at(seconds));
    };
    environment->scale = vec3(mean_brightness(moment, scale));
    environment->volume_scale = mean_factor(moment, source.volume_scale, scale);
    environment->surface_scale = mean_factor(moment, source.surface_scale, scale);
    environment->shadows = source.shadows, environment->casters = links.x, environment->lit = links.y;
    if (!is_finite(4 * pi * environment->mean())) // the light of all directions
        refuse(scene.file.string(), named("light", source.name) + ": its radiance overflows");
    const bool shines =
        max_component(environment->mean()) > 0 && std::max(environment->volume_scale, environment->surface_scale) > 0;
    return shines ? environment : nullptr;
}
}
