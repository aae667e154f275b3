// The results of tyndall stress as one self-contained HTML page.
#include "measuring/stress_report.h"

#include "measure/report/svg.h"

namespace tyndall {
namespace {
constexpr const char* style = R"(
body { font: 14px/1.4 system-ui, sans-serif; margin: 2em; color: #222; background: #fff }
table { border-collapse: collapse } th, td { text-align: left; vertical-align: top; padding: 3px 8px }
thead th { position: sticky; top: 0; background: #fff; border-bottom: 2px solid #888 }
tbody th { font-weight: normal; min-width: 17em; max-width: 30em } tbody th b { font-weight: 600 }
tr.group th { font-size: 115%; font-weight: 600; padding-top: 1em; border-bottom: 1px solid #ccc }
td { border: 2px solid #fff; min-width: 6em } td.holds { background: #d9efd6 } td.degrades { background: #fbe8b5 }
td.fails { background: #f3b9b3; font-weight: 600 } summary { cursor: pointer; white-space: nowrap }
small { color: #666 } td table { font-size: 85%; background: #fff } td table td { border: 1px solid #ddd; min-width: 0 }
)";

// A row for every value of the sweep: error, allowed error, bias and the warning given.
std::string points_table(const StressResult& result) {
    std::string text =
        "<table><tr><td>" + xml_text(result.stress->sweep) + "<td>error<td>allowed<td>bias<td>warning</tr>";
    for (const StressPoint& point : result.points) {
        text += formatted("<tr><td>%s<td>%.3g<td>%.3g<td>%s<td>%s",
                          xml_text(stress_value(*result.stress, point.value)).c_str(), point.error, point.allowed,
                          point.bias < 0 ? "" : formatted("%.3g", point.bias).c_str(), xml_text(point.warning).c_str());
        if (!point.clean())
            text += formatted(" %llu not finite, %llu negative", static_cast<unsigned long long>(point.non_finite),
                              static_cast<unsigned long long>(point.negative));
        text += "</tr>";
    }
    return text + "</table>";
}

std::string cell(const StressResult* result) {
    if (!result) return "<td>";
    const StressPoint* point = result->first();
    std::string verdict = "holds";
    if (point)
        verdict = (point->silent() ? "fails at " : "from ") + xml_text(stress_value(*result->stress, point->value));
    return "<td class=" + std::string(name_of(result->verdict())) + "><details><summary>" + verdict + "</summary>" +
           points_table(*result) + "</details>";
}
}

std::string stress_html(const StressReport& report) {
    std::string text = "<!DOCTYPE html>\n<html lang=en><meta charset=utf-8><title>Tyndall: stability</title>\n<style>" +
                       std::string(style) + "</style>\n<h1>Stability of every mode</h1>\n<p>" +
                       xml_text(stress_summary(report)) +
                       ".</p>\n<p>Each case sweeps a condition from mild to hard. Green: the mode holds throughout. "
                       "Yellow: it degrades from this value on and warns before it renders. Red: it fails without a "
                       "warning. Click a result to see every value.</p>\n<table><thead><tr><th>case";
    for (const std::string& mode : report.modes) text += "<th>" + xml_text(mode);
    text += "</tr></thead><tbody>\n";
    std::string_view group;
    for (const StressCase* stress : report.cases()) {
        if (stress->group != group)
            text += formatted("<tr class=group><th colspan=%zu>", report.modes.size() + 1) + xml_text(stress->group) +
                    "</tr>\n";
        group = stress->group;
        text += "<tr><th><b>" + xml_text(stress->id) + "</b> " + xml_text(stress->title) + "<br><small>" +
                xml_text(stress->measure.criterion) + "</small>";
        for (const std::string& mode : report.modes) text += cell(report.find(*stress, mode));
        text += "</tr>\n";
    }
    return text + "</tbody></table>\n</html>\n";
}
}
