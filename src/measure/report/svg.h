// Drawings as SVG files that need nothing else.
#pragma once
#include <string>
#include <string_view>

namespace tyndall {
enum class Anchor { start, middle, end };

// Of text as it is drawn, about: letters of 12 units.
double text_width(std::string_view text);
std::string shortened(std::string_view text, double width);

// The smallest of 1, 2, 5, 10, 20 ... or their tenths that goes into a length at most so often.
double tick_of(double length, double most);

// Text with what XML cannot hold replaced.
std::string xml_text(std::string_view text);

// Elements one after the other; coordinates in pixels from the upper left.
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
