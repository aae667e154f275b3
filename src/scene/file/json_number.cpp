// Floats as decimal text for scene files.
#include "base/error.h"
#include "scene/file/scene_words.h"

#include <charconv>
#include <cmath>

namespace tyndall {
std::string json_number(float value) {
    if (!std::isfinite(value)) refuse("a number", "is not finite");
    if (value == 0) return std::signbit(value) ? "-0.0" : "0"; // "-0" would be read as an integer, without its sign
    char digits[64];
    char* const end = digits + sizeof digits;
    const bool whole = value == std::floor(value) && std::abs(value) < 1e7f;
    const std::string text(digits, whole ? std::to_chars(digits, end, value, std::chars_format::fixed).ptr
                                         : std::to_chars(digits, end, value).ptr);
    double read = 0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    if (static_cast<float>(read) == value) return text;
    return std::string(digits, std::to_chars(digits, end, static_cast<double>(value)).ptr); // avoids double rounding
}
}
