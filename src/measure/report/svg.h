// Self-contained SVG drawings.
#pragma once
#include <string>
#include <string_view>

namespace tyndall {
enum class Anchor { start, middle, end };

// Approximate width of text at a font size of 12; text cut to a width.
double text_width(std::string_view text);
std::string shortened(std::string_view text, double width);

// The smallest of 1, 2 and 5 times a power of ten that divides `length` into at most `most` intervals.
double tick_of(double length, double most);

// Text with XML's special characters escaped and control characters replaced.
std::string xml_text(std::string_view text);

// Elements in drawing order; coordinates in pixels from the upper left.
class Svg {
public:
    void line(double x1, double y1, double x2, double y2, const char* color, double thickness, const char* dashes = "");
    void bar(double x, double y, double width, double height, const char* color, double opacity, std::string_view tip);
    void path(std::string_view commands, const char* stroke, double thickness, const char* fill = "none");
    void text(double x, double y, std::string_view words, Anchor anchor, const char* attributes = "");

    std::string finished(double width, double height, std::string_view title) const;

private:
    std::string elements_;
};
}
