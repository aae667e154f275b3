// The modes' results as text.
#include "measure/explain/text.h"

#include "base/error.h"
#include "base/text.h"

#include <algorithm>

namespace tyndall {
namespace {
std::string result_text(const ModeResult& result, const ModeResult* reference) {
    const std::string off = !result.finite ? "not finite" : reference ? difference_text(result, *reference) : "";
    return formatted("  %-14s %s %19s %9s %8s %8d\n", result.mode.c_str(), color_columns(result.inscatter).c_str(),
                     off.c_str(), percent(result.transmittance).c_str(), percent(result.validity).c_str(),
                     result.steps);
}

// A limitation of one or more lights or media, and the modes that share it.
struct Said {
    std::vector<std::string> modes;
    LimitationGroup group;
};
}

std::string limitations_text(const RayReport& report) {
    std::vector<Said> all;
    for (const ModeResult& result : report.results)
        for (LimitationGroup& group : groups_of(result.limitations)) {
            if (group.worst.severity == Severity::info) continue;
            const auto known = std::ranges::find(all, group, &Said::group);
            if (known != all.end())
                known->modes.push_back(result.mode);
            else
                all.push_back({{result.mode}, std::move(group)});
        }
    std::string text;
    for (const Said& said : all) text += report_lines("  " + joined(said.modes, ", ") + ": " + line_of(said.group), 6);
    return text.empty() ? text : "Limitations of the modes on this ray\n" + text;
}

std::string modes_text(const RayReport& report) {
    std::string text = "What each mode gives: fog light of one sample at the pixel's center, nits\n";
    text += formatted("  %-14s %s %19s %9s %8s %8s\n", "", channels().c_str(), "error", "through", "valid", "steps");
    text += result_text(report.reference, nullptr);
    for (const ModeResult& result : report.results) text += result_text(result, &report.reference);
    for (const ModeResult& result : report.results)
        if (!result.remark.empty())
            text += report_lines(formatted("  %-14s ", result.mode.c_str()) + result.remark, 17);
    return text;
}
}
