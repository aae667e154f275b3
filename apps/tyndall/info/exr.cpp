// tyndall info: OpenEXR images.
#include "common.h"
#include "reports.h"

#include "base/error.h"
#include "render/image/exr.h"

#include <algorithm>

namespace tyndall {
namespace {
struct ChannelStatistics {
    double low = std::numeric_limits<double>::infinity(), high = -low, mean = 0;
    uint64_t finite = 0, non_finite = 0;
};

ChannelStatistics statistics_of(const Image<float>& image) {
    ChannelStatistics result;
    for (const float value : image.pixels) {
        if (!std::isfinite(value)) {
            ++result.non_finite;
            continue;
        }
        result.low = std::min(result.low, double{value}), result.high = std::max(result.high, double{value});
        result.mean += value;
        ++result.finite;
    }
    if (result.finite) result.mean /= static_cast<double>(result.finite);
    return result;
}

Json channel_json(const std::string& name, const ChannelStatistics& s) {
    return json_object(
        {{"name", name}, {"minimum", s.low}, {"maximum", s.high}, {"mean", s.mean}, {"non_finite", s.non_finite}});
}

std::string channel_text(const std::string& name, const ChannelStatistics& s) {
    const std::string values =
        s.finite ? formatted("%g to %g, mean %g", s.low, s.high, s.mean) : std::string("no finite value");
    const std::string rest = s.non_finite ? ", " + std::to_string(s.non_finite) + " not finite" : "";
    return formatted("  %-20s %s%s\n", printable(name, 60).c_str(), values.c_str(), rest.c_str());
}
}

std::string exr_report(const std::filesystem::path& file, bool json) {
    const ExrFile exr = read_exr(file);
    std::vector<Json> channels;
    std::string lines;
    for (const auto& [name, image] : exr.channels) {
        const ChannelStatistics statistics = statistics_of(image);
        channels.push_back(channel_json(name, statistics));
        lines += channel_text(name, statistics);
    }
    if (json) {
        return json_line({{"file", file.native()},
                          {"kind", "exr"},
                          {"display", exr.display},
                          {"low", exr.low},
                          {"size", exr.size},
                          {"compression", exr.compression},
                          {"channels", channels},
                          {"attributes", json_object({exr.attributes.begin(), exr.attributes.end()})}});
    }
    std::string text = formatted("%s: OpenEXR, %d x %d pixels, %s compression\n", printable(file.string()).c_str(),
                                 exr.display.x, exr.display.y, printable(exr.compression, 40).c_str());
    if (exr.low != ivec2(0) || exr.size != exr.display)
        text += formatted("  contains the pixels %d,%d to %d,%d\n", exr.low.x, exr.low.y, exr.low.x + exr.size.x,
                          exr.low.y + exr.size.y);
    text += lines;
    for (const auto& [name, value] : exr.attributes)
        text += "  " + printable(name, 80) + " = " + printable(value, 300) + "\n";
    return text;
}
}
