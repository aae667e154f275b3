#include "volume/rays/steps.h"

#include "volume/medium.h"
#include "volume/rays/spans.h"

#include <cassert>

namespace tyndall {
namespace {
// Adjacent spans that are not `apart`: steps may cross the boundaries between them.
struct Run {
    size_t first = 0, end = 0;
    double cost = 0; // number of steps it needs, not rounded
};

// Steps per meter required by a rule, precomputed for many spans.
struct Rates {
    double by_length, by_depth;

    explicit Rates(const StepRule& rule) : by_length(1.0 / rule.length), by_depth(1.0 / rule.optical_depth) {}
    double of(const Span& span) const { return std::max({by_length, span.rate, span.extinction * by_depth}); }
};

// Reused from ray to ray, so allocation stops after the longest ray.
struct Scratch {
    std::vector<Span> spans, more, merged;
    std::vector<double> rates; // steps per meter of each span
    std::vector<Run> runs;
};

void collect_spans(const Ray& ray, std::span<const Medium> media, const StepRule& rule, Scratch& scratch) {
    scratch.spans.clear();
    const double t_end = horizon(ray, media);
    for (const Medium& medium : media) {
        if (gray_extinction(medium.optics) == 0 && medium.optics.emission.radiance == vec3(0)) continue;
        scratch.more.clear();
        append_spans(ray, medium, t_end, rule, scratch.more);
        if (scratch.spans.empty()) {
            std::swap(scratch.spans, scratch.more);
            continue;
        }
        scratch.merged.clear();
        overlay(scratch.spans, scratch.more, true, scratch.merged);
        std::swap(scratch.spans, scratch.merged);
    }
}

void refine(Scratch& scratch) {
    if (scratch.more.empty()) return;
    scratch.merged.clear();
    overlay(scratch.spans, scratch.more, false, scratch.merged);
    std::swap(scratch.spans, scratch.merged);
}

// Splits the spans where a local light or its beam requires smaller steps.
void refine_near(const Ray& ray, const StepRule& rule, const Rates& rates, Scratch& scratch) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Span& span : scratch.spans) lowest = std::min(lowest, rates.of(span));
    for (const vec3 point : rule.near_points) {
        scratch.more.clear();
        append_near_spans(ray, point, rule.near_least, rule.near_ratio, 1 / lowest, scratch.more);
        refine(scratch);
    }
    for (const Step& beam : rule.beams) {
        const double low = beam.low, high = beam.high, rate = rule.beam_steps / (high - low);
        scratch.more.clear();
        if (high > low && rate > lowest) scratch.more.push_back({low, high, 0, rate});
        refine(scratch);
    }
}

void find_runs(const Rates& rates, Scratch& scratch) {
    scratch.rates.clear(), scratch.runs.clear();
    for (size_t i = 0; i < scratch.spans.size(); ++i) {
        const Span& span = scratch.spans[i];
        const Span* before = i ? &scratch.spans[i - 1] : nullptr;
        if (!before || span.low > before->high || span.apart || before->apart) scratch.runs.push_back({i, i, 0});
        scratch.rates.push_back(rates.of(span));
        scratch.runs.back().end = i + 1;
        scratch.runs.back().cost += (span.high - span.low) * scratch.rates.back();
    }
}

// Number of steps of a run. A cost that exceeds an integer only by rounding does not add a step.
double wanted_steps(const Run& run) { return std::max(1.0, std::ceil(run.cost * (1 - 1e-6))); }

void append_step(double low, double high, std::vector<Step>& steps) {
    const Step step{static_cast<float>(low), static_cast<float>(high)};
    if (step.low < step.high) steps.push_back(step);
}

void place_run(const Scratch& scratch, const Run& run, int count, std::vector<Step>& steps) {
    const size_t first = steps.size();
    steps.resize(first + static_cast<size_t>(count));
    Step* step = steps.data() + first;
    const double share = run.cost / count;
    double before = 0, placed = 1;
    float low = static_cast<float>(scratch.spans[run.first].low);
    const auto end_step = [&](double t) {
        const float high = static_cast<float>(t);
        *step = {low, high};
        step += low < high;
        low = high;
    };
    for (size_t i = run.first; i < run.end; ++i) {
        const Span& span = scratch.spans[i];
        const double after = before + (span.high - span.low) * scratch.rates[i], length = 1 / scratch.rates[i];
        for (; placed < count && share * placed < after; ++placed)
            end_step(span.low + (share * placed - before) * length);
        before = after;
    }
    end_step(scratch.spans[run.end - 1].high);
    steps.resize(static_cast<size_t>(step - steps.data()));
}

// More runs than steps: each step covers several runs and the gaps between them.
void place_joined(const Scratch& scratch, size_t most, std::vector<Step>& steps) {
    const size_t runs = scratch.runs.size(), share = (runs + most - 1) / most;
    for (size_t i = 0; i < runs; i += share) {
        const Run &first = scratch.runs[i], &last = scratch.runs[std::min(i + share, runs) - 1];
        append_step(scratch.spans[first.first].low, scratch.spans[last.end - 1].high, steps);
    }
}
}

void append_steps(const Ray& ray, std::span<const Medium> media, const StepRule& rule, std::vector<Step>& steps) {
    assert(rule.optical_depth > 0 && rule.voxels > 0 && rule.length > 0 && rule.most > 0);
    if (!is_finite(ray.origin) || !is_finite(ray.direction)) return;
    static thread_local Scratch scratch;
    collect_spans(ray, media, rule, scratch);
    const Rates rates(rule);
    if (!rule.near_points.empty() || !rule.beams.empty()) refine_near(ray, rule, rates, scratch);
    find_runs(rates, scratch);

    const size_t most = static_cast<size_t>(rule.most), runs = scratch.runs.size();
    if (runs >= most) return place_joined(scratch, most, steps);
    double wanted = 0, cost = 0;
    for (const Run& run : scratch.runs) wanted += wanted_steps(run), cost += run.cost;
    for (const Run& run : scratch.runs) {
        const double count = wanted <= rule.most ? wanted_steps(run) : 1 + std::floor(run.cost * (most - runs) / cost);
        place_run(scratch, run, static_cast<int>(count), steps);
    }
}
}
