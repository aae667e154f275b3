#include "measuring/stress_resume.h"

#include "base/error.h"
#include "base/io/file.h"
#include "modes/mode.h"

namespace tyndall {
namespace {
// The first entry of a list whose value at `key` is `text`, or null.
const Json* entry_with(const Json* list, std::string_view key, std::string_view text) {
    if (list)
        for (const Json& entry : list->items)
            if (entry.string_or(key, "") == text) return &entry;
    return nullptr;
}

// JSON has no infinity: reports have null for it.
double number_of(const Json& json, std::string_view key) {
    const Json* number = json.find(key);
    return number && number->kind == Json::Kind::number ? number->number : infinity;
}

uint64_t count_of(const Json& json, std::string_view key) {
    return static_cast<uint64_t>(std::clamp(json.number_or(key, 0), 0.0, 1e15));
}

StressPoint point_of(const Json& json, const StressMeasure& measure) {
    StressPoint point;
    point.value = number_of(json, "value");
    point.error = number_of(json, "error"), point.allowed = number_of(json, "allowed");
    point.allowed_bias = measure.allowed_bias;
    if (std::isfinite(point.allowed_bias)) point.bias = number_of(json, "bias");
    point.wrong = json.boolean_or("wrong", false);
    if (point.wrong) point.measured = number_of(json, "rmse_rel");
    point.warning = json.string_or("warning", "");
    if (json.boolean_or("said", false)) point.excused_up_to = number_of(json, "excused_up_to");
    point.non_finite = count_of(json, "non_finite"), point.negative = count_of(json, "negative");
    return point;
}

// The result of one mode; without points when their values are not those of the case.
StressResult result_of(const Json& json, const StressCase& stress, const std::string& mode) {
    StressResult result{&stress, mode, {}, json.number_or("seconds", 0)};
    if (const Json* points = json.find("points"))
        for (const Json& point : points->items) result.points.push_back(point_of(point, stress.measure));
    const bool same = std::ranges::equal(result.points, stress.values, {}, &StressPoint::value);
    if (!same) result.points.clear();
    return result;
}
}

EarlierStress earlier_stress(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return {};
    Json report = parse_json(read_file(file), file.string());
    if (report.string_or("version", "") != TYNDALL_VERSION) return {};
    return {std::move(report)};
}

std::vector<StressResult> kept_results(const EarlierStress& earlier, const StressCase& stress,
                                       std::span<const Mode> modes) {
    std::vector<std::string> names;
    for (const Mode& mode : modes)
        if (takes_part(stress, mode)) names.emplace_back(mode.name);
    if (stress.modes.program()) names.emplace_back("program");

    const Json* found = entry_with(earlier.report.find("cases"), "case", stress.id);
    std::vector<StressResult> results;
    for (const std::string& name : names) {
        const Json* result = entry_with(found ? found->find("results") : nullptr, "mode", name);
        if (result) results.push_back(result_of(*result, stress, name));
        if (!result || results.back().points.empty()) return {};
    }
    return results;
}
}
