// The modes' results as bars beside the reference.
#include "measure/explain/svg.h"

#include "base/text.h"

#include <algorithm>

namespace tyndall {
using namespace ray_drawing;

namespace {
void draw_result(const ModeResult& result, const ModeResult* reference, double y, double scale, Svg& svg) {
    constexpr double bars = 480; // their right end
    const double value = luminance(result.inscatter), share = value / scale;
    svg.text(left - 8, y + 12, result.mode, Anchor::end);
    const double length = (bars - left) * std::clamp(share, 0.0, 1.0);
    const double sure = std::clamp(double(result.validity), 0.0, 1.0); // paler at low validity
    svg.bar(left, y, length, 16, reference ? "#0072B2" : ink, reference ? 0.3 + 0.7 * sure : 1, result.remark);
    if (share > 1) svg.text(bars - 4, y + 12, "▸", Anchor::end, "fill='#fff'");
    svg.text(bars + 80, y + 12, digits(value), Anchor::end);
    std::string off = !result.finite ? "not finite" : reference ? difference_text(result, *reference) : "";
    if (const size_t at = off.find("+-"); at != off.npos) off.replace(at, 2, "±");
    svg.text(bars + 230, y + 12, off, Anchor::end);
    svg.text(bars + 320, y + 12, percent(result.transmittance), Anchor::end);
    svg.text(bars + 410, y + 12, percent(result.validity), Anchor::end);
    svg.text(bars + 500, y + 12, std::to_string(result.steps), Anchor::end);
}
}

double draw_modes(const RayReport& report, double top, Svg& svg) {
    const double exact = luminance(report.reference.inscatter);
    double most = exact;
    for (const ModeResult& result : report.results) most = std::max<double>(most, luminance(result.inscatter));
    double scale = exact > 0 ? std::min(1.02 * most, 2.5 * exact) : most;
    if (!(scale > 0)) scale = 1;
    svg.text(left, top, "What each mode renders", Anchor::start, "font-weight='bold'");
    const std::pair<double, const char*> heads[] = {
        {560, "nits"}, {710, "error"}, {800, "through"}, {890, "valid"}, {980, "steps"}};
    for (const auto& [x, head] : heads) svg.text(x, top, head, Anchor::end, "fill='#666'");
    double y = top + 8;
    draw_result(report.reference, nullptr, y, scale, svg);
    for (const ModeResult& result : report.results) draw_result(result, &report.reference, y += 22, scale, svg);
    const double x = left + (480 - left) * exact / scale;
    svg.line(x, top + 8, x, y + 16, "#D55E00", 1.5, "4 3");
    y += 40;
    for (const ModeResult& result : report.results) {
        if (result.remark.empty()) continue;
        svg.text(left, y, result.mode + ": " + result.remark, Anchor::start, "fill='#666'");
        y += 18;
    }
    return y;
}
}
