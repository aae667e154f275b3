// The explanation of a ray as text, as a drawing and as a table.
#pragma once
#include "measure/explain/explain.h"

namespace tyndall {
struct ReportTitle {
    std::string scene, camera, quality;
    int frame = 1;
};
std::string title_line(const RayReport& report, const ReportTitle& title);

// For people, in lines of up to 100 columns.
std::string explain_text(const RayReport& report, const ReportTitle& title);

// A self-contained SVG: fog, transmittance, light per meter and lit stretches over a common distance axis, and the
// modes' results beside the reference.
std::string explain_svg(const RayReport& report, const ReportTitle& title);

// CSV of every step, with what each light contributes.
std::string explain_csv(const RayReport& report);

// Numbers of a report: four digits, and shares in percent.
std::string digits(double value);
std::string percent(double share);
// A result's difference from the reference: "+3.1 %", with the standard error of a noisy result.
std::string difference_text(const ModeResult& result, const ModeResult& reference);

// Light that a step adds at the eye, from all sources.
vec3 added_by(const RayReport& report, size_t step);
}
