#include "measure/chart/earlier_points.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/json/json_values.h"
#include "base/parallel.h"
#include "base/shrink.h"
#include "measure/metrics/heatmap.h"
#include "modes/mode.h"
#include "render/image/png.h"
#include "render/sequence/job.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr HeatScale error_scale{1e-3, 10, true};
constexpr int small_width = 240, jpeg_quality = 82;

ivec2 small_size(ivec2 size) {
    const int width = std::min(size.x, small_width);
    return {width, std::max(1, size.y * width / size.x)};
}

Image<float> shrunk(const Image<float>& values, ivec2 size) {
    Image<vec3> colors(values.size);
    for (size_t i = 0; i < values.pixels.size(); ++i) colors.pixels[i] = vec3(values.pixels[i]);
    colors = shrunk(colors, size, [](vec3 value) { return value; });
    Image<float> result(size);
    for (size_t i = 0; i < result.pixels.size(); ++i) result.pixels[i] = colors.pixels[i].x;
    return result;
}
}

Json json_of_point(const ChartPoint& point) {
    Json result = json_object({{"mode", point.mode}, {"settings", point.settings}});
    for (const ChartField& field : chart_fields()) result.members.emplace_back(field.name, value_of(field, point));
    return result;
}

std::string point_hash(const ChartStage& stage, const ChartRung& rung, const std::string& references,
                       FileHashes& files) {
    RenderRequest request = stage.job.render;
    const RenderPlan plan{rung.mode, settings_of(rung), {}, {}, {}};
    std::string text = references + " " + std::to_string(stage.job.runs) + " " + std::to_string(thread_count());
    const auto add = [&](int frame) {
        text += frame_hash(stage.scene, request, plan, view_of(stage.scene, request, plan.settings, frame), files);
    };
    add(stage.job.frame), add(stage.next_frame);
    request.resolution = stage.sequence_size;
    for (const SequenceFrame& frame : stage.sequence) add(frame.frame), text += std::to_string(frame.pattern);
    return content_hash(text);
}

std::optional<ChartPoint> cached_point(const std::filesystem::path& directory, const ChartRung& rung,
                                       const std::string& hash) {
    ChartPoint point;
    point.mode = rung.mode->name, point.rung = rung.place; // for the files' names
    const PointFiles files = files_of(point);
    try {
        const Json json = parse_json(read_file(directory / files.values), files.values.string());
        const Json* own_hash = json.find("hash");
        if (!own_hash || own_hash->kind != Json::Kind::string || own_hash->string != hash) return {};
        for (const auto& file : {files.picture, files.errors, files.small_picture, files.small_errors})
            check_readable(directory / file);
        for (const ChartField& field : chart_fields()) {
            const Json* value = json.find(field.name);
            if (!value || (value->kind != Json::Kind::number && value->kind != Json::Kind::null)) return {};
            if (value->kind == Json::Kind::null && field.name == "error") return {}; // it was infinite
            field.of(point) = value->kind == Json::Kind::number ? value->number : not_measured;
        }
    } catch (const Error&) {
        return {};
    }
    point.settings = rows_of(settings_of(rung));
    return point;
}

void keep_point(const std::filesystem::path& directory, const MeasuredPoint& measured, const std::string& hash,
                const Display& display) {
    const PointFiles files = files_of(measured.point);
    const ivec2 small = small_size(measured.picture.size);
    const Image<vec3> picture = shrunk(measured.picture, small, [](vec3 color) { return color; });
    write_png(directory / files.picture, measured.picture, display);
    write_png(directory / files.errors, heat_map(measured.errors, error_scale));
    write_jpeg(directory / files.small_picture, display_codes(picture, display), jpeg_quality);
    write_jpeg(directory / files.small_errors, heat_map(shrunk(measured.errors, small), error_scale), jpeg_quality);

    Json json = json_of_point(measured.point);
    json.members.emplace_back("hash", hash);
    write_file_atomically(directory / files.values, format_json(json) + "\n");
}
}
