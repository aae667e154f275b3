// Tables for people, and the same as JSON.
#include "measuring/compare_report.h"

#include "base/error.h"

namespace tyndall {
namespace {
std::string percent(double error, double mean) { return formatted("%.4g %%", 100 * relative(error, mean)); }

Json non_finite_json(const Errors& e) {
    return json_object({{"test", e.non_finite_test}, {"reference", e.non_finite_reference}});
}

Json errors_json(const Errors& e) {
    return json_object({{"rmse_rel", relative(e.rmse, e.mean_reference)},
                        {"bias_rel", relative(e.bias, e.mean_reference)},
                        {"rmse", e.rmse},
                        {"bias", e.bias},
                        {"max", e.most},
                        {"mean", e.mean_test},
                        {"mean_reference", e.mean_reference},
                        {"non_finite", non_finite_json(e)}});
}

Json layers_json(const Comparison& comparison) {
    JsonMembers members;
    for (const auto& [name, errors] : comparison.layers) members.emplace_back(name, errors_json(errors));
    return json_object(std::move(members));
}

Json frame_json(const FrameResult& frame) {
    const Comparison& c = frame.comparison;
    Json json = errors_json(c.beauty);
    json.members.insert(json.members.begin(), {"E", c.worst_rmse()});
    json.members.insert(json.members.begin(), {"frame", frame.frame});
    json.members.emplace_back("rel_mse", c.beauty.rel_mse);
    json.members.emplace_back("ssim", c.ssim);
    json.members.emplace_back("flip", c.flip);
    json.members.emplace_back("layers", layers_json(c));
    return json;
}

Json metrics_json(const CompareResult& result) {
    JsonMembers members;
    for (const Metric& metric : metrics())
        if (const auto value = metric.value(result)) members.emplace_back(metric.name, *value);
    members.emplace_back("ssim", result.overall.ssim);
    if (result.overall.mse) members.emplace_back("mse_unbiased_error", result.overall.mse->standard_error);
    if (result.overall.bias_squared)
        members.emplace_back("bias_squared_error", result.overall.bias_squared->standard_error);
    return json_object(std::move(members));
}

std::string errors_table(const Errors& e) {
    const std::pair<const char*, double> rows[] = {{"bias", e.bias}, {"rmse", e.rmse},   {"mae", e.mae},
                                                   {"p95", e.p95},   {"p99_9", e.p99_9}, {"max", e.most}};
    std::string text =
        formatted("  %-16s %12s   share of the reference's mean (%.4g)\n", "", "difference", e.mean_reference);
    for (const auto& [name, value] : rows)
        text += formatted("  %-16s %12.4g   %s\n", name, value, percent(value, e.mean_reference).c_str());
    return text;
}

std::string layers_table(const CompareResult& result) {
    const Comparison& all = result.overall;
    std::string text = formatted("\n  %-24s %12s %12s %12s\n", "layer", "rmse_rel", "bias_rel", "mean");
    const auto row = [&](const std::string& name, const Errors& e) {
        text += formatted("  %-24s %12s %12s %12.4g", printable(name, 60).c_str(),
                          percent(e.rmse, e.mean_reference).c_str(), percent(e.bias, e.mean_reference).c_str(),
                          e.mean_reference);
        if (const uint64_t bad = e.non_finite_test + e.non_finite_reference)
            text += "  " + count_text(bad, "pixel") + " ignored, not finite";
        text += "\n";
    };
    row("image", all.beauty);
    for (const auto& [name, errors] : all.layers) row(name, errors);
    return text;
}

std::string frames_table(const CompareResult& result) {
    std::string text = formatted("\n  %8s %12s %12s %10s %10s\n", "frame", "rmse_rel", "bias_rel", "SSIM", "FLIP");
    for (const FrameResult& frame : result.frames) {
        const Errors& e = frame.comparison.beauty;
        text += formatted("  %8d %12s %12s %10.5f %10.5f\n", frame.frame, percent(e.rmse, e.mean_reference).c_str(),
                          percent(e.bias, e.mean_reference).c_str(), frame.comparison.ssim, frame.comparison.flip);
    }
    return text;
}
}

std::string compare_text(const CompareResult& result) {
    const Comparison& all = result.overall;
    std::string text = printable(result.test) + " against " + printable(result.reference) +
                       formatted(": %d x %d pixels", result.size.x, result.size.y);
    text += result.sequence ? ", " + count_text(result.frames.size(), "frame") + "\n" : std::string("\n");
    if (all.stylized)
        text += "stylized: rendered with artistic controls, so these are differences of look, not errors\n";
    text += errors_table(all.beauty);
    text += formatted("\n  %-16s %12.4g   without the largest 0.1 %%: %.4g\n", "relMSE", all.beauty.rel_mse,
                      all.beauty.rel_mse_trimmed);
    text += formatted("  %-16s %12.6f   1 when equal\n", "SSIM", all.ssim);
    text += formatted("  %-16s %12.6f   0 when equal; %g pixels per degree\n", "FLIP", all.flip,
                      result.viewing.pixels_per_degree);
    text += formatted("  %-16s %12.6f   as stored, clamped to 0..1\n", "LDR-FLIP", all.flip_ldr);
    if (all.noise)
        text += formatted("  %-16s %12.4g   %s: the part of rmse that is the image's own noise\n", "standard error",
                          *all.noise, percent(*all.noise, all.beauty.mean_reference).c_str());
    if (result.frames.size() > 1)
        text += formatted("  %-16s %12.4g   of the reference's mean\n", "flicker", result.flicker);
    if (all.mse)
        text += formatted("  %-16s %12.4g   ± %.2g, free of the reference's noise\n", "MSE, unbiased", all.mse->value,
                          all.mse->standard_error);
    if (all.bias_squared)
        text += formatted("  %-16s %12.4g   ± %.2g\n", "bias squared", all.bias_squared->value,
                          all.bias_squared->standard_error);
    text += formatted("  %-16s %12.4g   rmse_rel, the worse of the image and its fog light\n", "E", all.worst_rmse());
    text += layers_table(result);
    if (result.sequence) text += frames_table(result);
    return text;
}

std::string compare_json(const CompareResult& result, const std::vector<Exceeded>& exceeded) {
    const Errors& e = result.overall.beauty;
    const auto failure_json = [](const Exceeded& f) {
        return json_object({{"metric", f.metric}, {"value", f.value}, {"limit", f.limit}});
    };
    const FlipExposures& exposures = result.viewing.exposures;
    JsonMembers members{{"test", result.test},
                        {"reference", result.reference},
                        {"size", result.size},
                        {"pixels", e.pixels},
                        {"stylized", result.overall.stylized},
                        {"non_finite", non_finite_json(e)},
                        {"mean", e.mean_test},
                        {"mean_reference", e.mean_reference},
                        {"metrics", metrics_json(result)},
                        {"layers", layers_json(result.overall)},
                        {"viewing", json_object({{"pixels_per_degree", result.viewing.pixels_per_degree},
                                                 {"start_exposure", exposures.start},
                                                 {"stop_exposure", exposures.stop},
                                                 {"exposures", exposures.count}})},
                        {"exceeded", json_list(exceeded, failure_json)}};
    if (result.sequence) members.emplace_back("frames", json_list(result.frames, frame_json));
    return json_line(std::move(members));
}
}
