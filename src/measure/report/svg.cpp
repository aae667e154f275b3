#include "measure/report/svg.h"

#include "base/text.h"

#include <cmath>

namespace tyndall {
namespace {
constexpr double letter = 6.3; // mean width at a font size of 12

const char* name_of(Anchor anchor) {
    return anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
}
}

double text_width(std::string_view text) { return letter * static_cast<double>(text.size()); }

std::string shortened(std::string_view text, double width) {
    const size_t most = static_cast<size_t>(width / letter);
    return text.size() <= most ? std::string(text) : std::string(text.substr(0, most - 1)) + "~";
}

double tick_of(double length, double most) {
    const double least = length / most, ten = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * ten >= least * 0.9999) return factor * ten;
    return 10 * ten;
}

std::string xml_text(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        case '\'':
            result += "&apos;";
            break;
        default:
            result += static_cast<unsigned char>(c) < 32 ? '?' : c;
        }
    }
    return result;
}

void Svg::line(double x1, double y1, double x2, double y2, const char* color, double thickness, const char* dashes) {
    elements_ += formatted("<path d='M%.1f %.1fL%.1f %.1f' stroke='%s' stroke-width='%g' fill='none'", x1, y1, x2, y2,
                           color, thickness);
    if (*dashes) elements_ += formatted(" stroke-dasharray='%s'", dashes);
    elements_ += "/>\n";
}

void Svg::bar(double x, double y, double width, double height, const char* color, double opacity,
              std::string_view tip) {
    elements_ += formatted("<rect x='%.2f' y='%.1f' width='%.2f' height='%.1f' fill='%s' fill-opacity='%.3g'", x, y,
                           width, height, color, opacity);
    elements_ += tip.empty() ? "/>\n" : "><title>" + xml_text(tip) + "</title></rect>\n";
}

void Svg::path(std::string_view commands, const char* stroke, double thickness, const char* fill) {
    if (commands.empty()) return;
    elements_ +=
        "<path d='" + std::string(commands) +
        formatted("' stroke='%s' stroke-width='%g' stroke-linejoin='round' fill='%s'/>\n", stroke, thickness, fill);
}

void Svg::text(double x, double y, std::string_view words, Anchor anchor, const char* attributes) {
    elements_ += formatted("<text x='%.1f' y='%.1f' text-anchor='%s' %s>", x, y, name_of(anchor), attributes) +
                 xml_text(words) + "</text>\n";
}

std::string Svg::finished(double width, double height, std::string_view title) const {
    return formatted("<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' viewBox='0 0 %.0f %.0f' "
                     "font-family='Helvetica, Arial, sans-serif' font-size='12' fill='#222'>\n",
                     width, height, width, height) +
           "<title>" + xml_text(title) + "</title>\n<rect width='100%' height='100%' fill='#fff'/>\n" + elements_ +
           "</svg>\n";
}
}
