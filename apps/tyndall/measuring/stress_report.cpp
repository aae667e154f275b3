// Tables for people, and the same as JSON.
#include "measuring/stress_report.h"

#include <algorithm>

namespace tyndall {
namespace {
std::string cell_text(const StressResult* result) {
    if (!result) return "";
    const StressPoint* point = result->first();
    if (!point) return "holds";
    return formatted(point->silent() ? "FAILS %.3g" : "from %.3g", point->value);
}

// What failed at a point, or the warning that said it would.
std::string fault_text(const StressPoint& point) {
    std::string text = formatted("error %.3g, allowed %.3g", point.error, point.allowed);
    if (point.bias >= 0) text += formatted("; bias %.3g, allowed %.3g", point.bias, point.allowed_bias);
    if (point.non_finite) text += "; " + count_text(point.non_finite, "value") + " not finite";
    if (point.negative) text += "; " + count_text(point.negative, "value") + " below 0 or above 1";
    if (point.silent() && point.said()) return text + formatted("; its warning allows up to %.3g", point.excused_up_to);
    if (point.silent()) return text + "; no warning";
    return text + "; " + point.warning;
}

std::string details(const StressReport& report, Verdict verdict, const char* heading) {
    std::string text;
    for (const StressResult& result : report.results) {
        if (result.verdict() != verdict) continue;
        const StressPoint& point = *result.first();
        text +=
            formatted("  %s, %s, %s %s: ", std::string(result.stress->id).c_str(), result.mode.c_str(),
                      std::string(result.stress->sweep).c_str(), stress_value(*result.stress, point.value).c_str()) +
            fault_text(point) + "\n";
    }
    return text.empty() ? "" : "\n" + std::string(heading) + "\n" + text;
}

Json point_json(const StressPoint& point) {
    return json_object({{"value", point.value},
                        {"error", point.error},
                        {"allowed", point.allowed},
                        {"bias", point.bias < 0 ? Json() : Json(point.bias)},
                        {"holds", point.holds()},
                        {"said", point.said()},
                        {"excused_up_to", point.said() ? Json(point.excused_up_to) : Json()},
                        {"warning", point.warning},
                        {"wrong", point.wrong},
                        {"rmse_rel", point.measured < 0 ? Json() : Json(point.measured)},
                        {"non_finite", point.non_finite},
                        {"negative", point.negative}});
}

Json result_json(const StressResult& result) {
    const StressPoint* first = result.first();
    return json_object({{"mode", result.mode},
                        {"verdict", name_of(result.verdict())},
                        {"from", first ? Json(first->value) : Json()},
                        {"seconds", result.seconds},
                        {"points", json_list(result.points, point_json)}});
}

Json case_json(const StressReport& report, const StressCase& stress) {
    std::vector<Json> results;
    for (const std::string& mode : report.modes)
        if (const StressResult* result = report.find(stress, mode)) results.push_back(result_json(*result));
    return json_object({{"case", stress.id},
                        {"group", stress.group},
                        {"title", stress.title},
                        {"sweep", stress.sweep},
                        {"unit", stress.unit},
                        {"criterion", stress.measure.criterion},
                        {"results", results}});
}
}

int StressReport::count(Verdict verdict) const {
    return static_cast<int>(std::ranges::count(results, verdict, &StressResult::verdict));
}

const StressResult* StressReport::find(const StressCase& stress, const std::string& mode) const {
    const auto found = std::ranges::find_if(
        results, [&](const StressResult& result) { return result.stress == &stress && result.mode == mode; });
    return found != results.end() ? &*found : nullptr;
}

std::vector<const StressCase*> StressReport::cases() const {
    std::vector<const StressCase*> list;
    for (const StressResult& result : results)
        if (list.empty() || list.back() != result.stress) list.push_back(result.stress);
    return list;
}

std::string stress_value(const StressCase& stress, double value) {
    return formatted("%.3g", value) + (stress.unit.empty() ? "" : " " + std::string(stress.unit));
}

std::string stress_summary(const StressReport& report) {
    const WrongWarnings warnings = wrong_warnings(report.results);
    const size_t finished = report.cases().size();
    const std::string cases =
        finished < report.asked ? formatted("%zu of %zu cases", finished, report.asked) : count_text(finished, "case");
    return formatted("%s, %zu results: %d hold, %d degrade with a warning, %d fail silently; of %d warnings "
                     "\"wrong\" %d (%.1f %%) with an error below 5 %%",
                     cases.c_str(), report.results.size(), report.count(Verdict::holds),
                     report.count(Verdict::degrades), report.count(Verdict::fails), warnings.count, warnings.idle,
                     warnings.count ? 100.0 * warnings.idle / warnings.count : 0.0);
}

std::string stress_text(const StressReport& report) {
    std::string text = formatted("%-20s", "");
    for (const std::string& mode : report.modes) text += formatted(" %13s", mode.c_str());
    std::string_view group;
    for (const StressCase* stress : report.cases()) {
        if (stress->group != group) text += "\n" + std::string(stress->group) + "\n";
        group = stress->group;
        text += formatted("  %-18s", std::string(stress->id).c_str());
        for (const std::string& mode : report.modes)
            text += formatted(" %13s", cell_text(report.find(*stress, mode)).c_str());
        text.erase(text.find_last_not_of(' ') + 1);
        text += "\n";
    }
    return text + details(report, Verdict::degrades, "Degrades, with a warning beforehand:") +
           details(report, Verdict::fails, "Fails silently:") + "\n" + stress_summary(report) + "\n";
}

std::string stress_json(const StressReport& report) {
    const auto case_of = [&](const StressCase* stress) { return case_json(report, *stress); };
    const WrongWarnings warnings = wrong_warnings(report.results);
    return json_line({{"version", TYNDALL_VERSION},
                      {"asked", report.asked},
                      {"holds", report.count(Verdict::holds)},
                      {"degrades", report.count(Verdict::degrades)},
                      {"fails", report.count(Verdict::fails)},
                      {"wrong_warnings", warnings.count},
                      {"idle_warnings", warnings.idle},
                      {"seconds", report.seconds},
                      {"cases", json_list(report.cases(), case_of)}});
}

std::string stress_list(std::span<const StressCase* const> cases) {
    std::string text;
    std::string_view group;
    for (const StressCase* stress : cases) {
        if (stress->group != group) text += (group.empty() ? "" : "\n") + std::string(stress->group) + "\n";
        group = stress->group;
        std::string values;
        for (const double value : stress->values) values += formatted(values.empty() ? "%.3g" : ", %.3g", value);
        text += formatted("  %-18s %s\n  %-18s %s %s%s%s\n", std::string(stress->id).c_str(),
                          std::string(stress->title).c_str(), "", std::string(stress->sweep).c_str(), values.c_str(),
                          stress->unit.empty() ? "" : " ", std::string(stress->unit).c_str());
    }
    return text;
}
}
