#include "interface_times.h"

#include "base/text.h"

#include <algorithm>

namespace tyndall {
namespace {
double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const size_t place = std::min(static_cast<size_t>(share * static_cast<double>(values.size())), values.size() - 1);
    std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(place), values.end());
    return values[place];
}

std::string line(const char* name, const std::vector<double>& seconds) {
    return formatted("%s: %zu frames, half below %.2f ms, 95 %% below %.2f ms, all below %.2f ms\n", name,
                     seconds.size(), 1e3 * quantile(seconds, 0.5), 1e3 * quantile(seconds, 0.95),
                     1e3 * quantile(seconds, 1));
}
}

std::string times_text(const InterfaceTimes& times, const PictureCounts& counts) {
    std::string text = line("interface", times.interface) + line("gl", times.gl);
    text +=
        formatted("pictures: first after %.2f s, %d in %.2f s", times.first_picture, counts.pictures, times.seconds);
    if (counts.quick > 0) {
        const StageTimes& sum = counts.quick_stages;
        const double each = 1e3 / counts.quick;
        text +=
            formatted(", %d while things moved, %.1f per second\neach of these: scene %.1f ms, preparation %.1f ms, "
                      "rays %.1f ms, display %.1f ms",
                      counts.quick, counts.quick / counts.quick_seconds, each * sum.load, each * sum.prepare,
                      each * sum.render, each * sum.tone);
    }
    return text + "\n";
}
}
