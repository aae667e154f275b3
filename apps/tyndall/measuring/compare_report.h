// What tyndall compare found, as text and JSON, and the metrics it can be asked to fail on.
#pragma once
#include "common.h"

#include "measure/metrics/comparison.h"

#include <optional>
#include <string>
#include <vector>

namespace tyndall {
struct FrameResult {
    int frame = 0;
    Comparison comparison;
};

struct CompareResult {
    std::string test, reference; // as on the command line
    ivec2 size{0};
    bool sequence = false;
    Viewing viewing;
    std::vector<FrameResult> frames;
    Comparison overall;
    double flicker = 0; // of a sequence; NaN for a single frame
};

// One number of the whole result. Larger is worse for all of them.
struct Metric {
    std::string name, doc;
    std::optional<double> (*value)(const CompareResult&); // nullopt when the files lack the data for it
};
const std::vector<Metric>& metrics();

// A bound given by --fail-above. Throws Error (usage) when no metric has that name.
struct Bound {
    const Metric* metric;
    double limit;
};
Bound parsed_bound(const std::string& text);

struct Exceeded {
    std::string metric;
    double value, limit;
};

std::string compare_text(const CompareResult& result);
std::string compare_json(const CompareResult& result, const std::vector<Exceeded>& exceeded);
}
