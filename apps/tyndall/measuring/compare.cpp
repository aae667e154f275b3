// tyndall compare: measures the errors of images against a reference.
#include "base/error.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "measure/metrics/heatmap.h"
#include "measuring/compare_report.h"
#include "render/image/png.h"

namespace tyndall {
namespace {
struct Options {
    std::string test, reference, frames, heatmap, map, pixels_per_degree;
    std::vector<std::string> fail_above;
};

struct Pair {
    int frame;
    std::string test, reference;
};

// What a heat map can show.
struct MapKind {
    const char* unit;
    HeatScale scale;
};
constexpr MapKind map_kinds[] = {{"of the reference's mean, logarithmic", {1e-3, 10, true}}, {"FLIP", {0, 1, false}}};
enum : size_t { error_kind, flip_kind };

// What the command line sets.
struct Job {
    std::vector<Pair> pairs;
    std::vector<Bound> bounds;
    double pixels_per_degree = flip_pixels_per_degree;
    size_t map = error_kind;
    std::string heatmap;
    bool sequence = false;
};

std::vector<Pair> make_pairs(const Options& args) {
    const bool sequence = has_frame_token(args.test);
    if (!sequence && has_frame_token(args.reference))
        fail(ExitCode::usage, args.test,
             "this is one image, but the reference is a sequence: give one reference image");
    if (!sequence && !args.frames.empty())
        fail(ExitCode::usage, "--frames",
             "is for sequences, like a.####.exr; " + printable(args.test) + " is one file");
    if (!sequence) return {{0, args.test, args.reference}};
    if (args.frames.empty()) fail(ExitCode::usage, args.test, "a sequence needs --frames, like --frames 1-24");
    std::vector<Pair> pairs;
    for (const int frame : parse_frames(args.frames))
        pairs.push_back({frame, frame_name(args.test, frame), frame_name(args.reference, frame)});
    return pairs;
}

Job make_job(const Options& args, OutputPaths& places) {
    Job job;
    job.pairs = make_pairs(args);
    job.sequence = has_frame_token(args.test);
    for (const std::string& text : args.fail_above) {
        job.bounds.push_back(parsed_bound(text));
        if (job.bounds.back().metric->name == "flicker" && job.pairs.size() < 2)
            fail(ExitCode::usage, "--fail-above", "flicker needs a sequence of at least two frames");
    }
    if (!args.pixels_per_degree.empty())
        job.pixels_per_degree = number_option("--ppd", args.pixels_per_degree, 1, 1000);
    if (!args.map.empty() && args.heatmap.empty()) fail(ExitCode::usage, "--map", "needs --heatmap FILE.png");
    if (!args.map.empty()) job.map = choice_among("--map", args.map, {"error", "flip"});
    job.heatmap = args.heatmap;
    if (job.heatmap.empty()) return job;

    check_pattern(job.heatmap, ".png", job.pairs.size() > 1, "--heatmap");
    std::vector<int> frames;
    for (const Pair& pair : job.pairs) frames.push_back(pair.frame);
    places.check(job.heatmap, frames, "--heatmap");
    return job;
}

// Reads references and keeps the last one in memory, since it may serve all frames.
class References {
public:
    const ExrColors& read(const std::string& file) {
        if (!last_ || last_->file != file) last_ = read_exr_colors(file);
        return *last_;
    }

private:
    std::optional<ExrColors> last_;
};

// The same viewing conditions for all frames.
Viewing common_viewing(const Job& job, References& references) {
    std::vector<Viewing> frames;
    for (size_t i = 0; i < job.pairs.size(); ++i) {
        stop_if_cancelled();
        if (i > 0 && job.pairs[i].reference == job.pairs[i - 1].reference) continue;
        frames.push_back(viewing_of(references.read(job.pairs[i].reference).beauty));
    }
    Viewing viewing = covering(frames);
    viewing.pixels_per_degree = job.pixels_per_degree;
    return viewing;
}

void write_heat_map(const Job& job, const Pair& pair, const Image<float>& map) {
    write_png(frame_name(job.heatmap, pair.frame), heat_map(map, map_kinds[job.map].scale));
}

CompareResult compare_all(const Job& job, Progress* progress) {
    References references;
    CompareResult result;
    result.sequence = job.sequence;
    result.viewing = common_viewing(job, references);
    Flicker flicker;
    for (const Pair& pair : job.pairs) {
        stop_if_cancelled();
        const ExrColors test = read_exr_colors(pair.test);
        const ExrColors& reference = references.read(pair.reference);
        check_same_frame(test, reference);
        if (!result.frames.empty() && test.beauty.size != result.size)
            refuse(pair.test, "its size differs from the earlier frames");
        result.size = test.beauty.size;

        Image<float> map;
        result.frames.push_back({pair.frame, compare(test, reference, result.viewing, &map)});
        flicker.add_frame(test.beauty, reference.beauty);
        if (!job.heatmap.empty()) {
            const double mean = result.frames.back().comparison.beauty.mean_reference;
            if (job.map == error_kind) map = error_map(test.beauty, reference.beauty, mean);
            write_heat_map(job, pair, map);
        }
        if (progress) progress->set(static_cast<double>(result.frames.size()));
    }
    std::vector<Comparison> comparisons;
    for (const FrameResult& frame : result.frames) comparisons.push_back(frame.comparison);
    result.overall = pooled(comparisons);
    result.flicker = flicker.value();
    return result;
}

// Undefined values (NaN) count as above any limit.
std::vector<Exceeded> find_exceeded(const CompareResult& result, const std::vector<Bound>& bounds) {
    std::vector<Exceeded> exceeded;
    for (const Bound& bound : bounds) {
        const auto value = bound.metric->value(result);
        if (!value)
            fail(ExitCode::usage, "--fail-above", bound.metric->name + " is not available: " + bound.metric->doc);
        const double size =
            bound.metric->name.starts_with("bias_rel") || bound.metric->name == "bias" ? std::abs(*value) : *value;
        if (!(size <= bound.limit)) exceeded.push_back({bound.metric->name, *value, bound.limit});
    }
    return exceeded;
}

void say_scale(const Job& job) {
    const MapKind& kind = map_kinds[job.map];
    say(formatted("heat map: black %g, white %g %s; green: not a number; ", kind.scale.low, kind.scale.high,
                  kind.unit) +
        printable(job.heatmap));
}

int run_compare(const Options& args, const Globals& globals) {
    OutputPaths places;
    const Job job = make_job(args, places);
    std::optional<Progress> progress;
    if (job.pairs.size() > 1)
        progress.emplace(globals.progress, "compare", static_cast<double>(job.pairs.size()), true);
    CompareResult result = compare_all(job, progress ? &*progress : nullptr);
    if (progress) progress->finish();
    result.test = args.test, result.reference = args.reference;

    const std::vector<Exceeded> exceeded = find_exceeded(result, job.bounds);
    print_report(globals.json ? compare_json(result, exceeded) : compare_text(result));
    if (!job.heatmap.empty() && !globals.quiet) say_scale(job);
    for (const Exceeded& e : exceeded)
        say(e.metric + (std::isnan(e.value) ? std::string(" is undefined") : formatted(" is %g", e.value)) +
            formatted("; the limit is %g", e.limit));
    if (!exceeded.empty()) return static_cast<int>(ExitCode::differs);

    const uint64_t bad = result.overall.non_finite();
    if (bad == 0) return 0;
    fail(ExitCode::non_finite, printable(args.test) + " against " + printable(args.reference),
         count_text(bad, "pixel") + " of images and layers are not finite; the rest was compared");
}

std::string metric_help() {
    std::string text = "Metrics for --fail-above (larger is worse):\n";
    for (const Metric& metric : metrics()) text += formatted("  %-16s %s\n", metric.name.c_str(), metric.doc.c_str());
    return text;
}
}

Run add_compare(const Command& program) {
    const Command command = program.command("compare", "measure how far images are from a reference");
    auto args = std::make_shared<Options>();
    command.option("A.exr", args->test, "the image, or a sequence: a.####.exr", "").required();
    command.option("B.exr", args->reference, "the reference: what A should look like; a sequence or one file", "")
        .required();
    command.option("--frames", args->frames, "frames of a sequence: 1-24, 1-48x2, 1,5,9", "RANGE");
    command.options("--fail-above", args->fail_above,
                    "exit with code 1 when METRIC (of all frames together) is larger than\n"
                    "VALUE; may be repeated",
                    "METRIC=VALUE");
    command.option("--heatmap", args->heatmap,
                   "an image that shows where the differences are; the strip below it is the\n"
                   "scale",
                   "FILE.png");
    command.option("--map", args->map,
                   "what the heat map shows: error (default), 0.001 to 10 times the\n"
                   "reference's mean on a logarithmic scale; or flip, 0 to 1",
                   "WHAT");
    command.option("--ppd", args->pixels_per_degree, "pixels per degree of visual angle, for FLIP (default: 67)", "N");
    command.footer(
        "Example: is the quick render within 5 % of the good one?\n"
        "  tyndall compare quick.exr good.exr --heatmap where.png --fail-above rmse_rel=0.05\n"
        "  tyndall compare 'quick.####.exr' 'good.####.exr' --frames 1-24 --json\n"
        "Both must show the same pixels: same size, same crop. Layers both files have (inscatter,\n"
        "transmittance, lights) are compared too, Z is not. Pixels that are not finite numbers are counted and\n"
        "ignored. Against a black reference relative values are 0 or infinite; JSON has null for infinite or\n"
        "undefined.\n" +
        metric_help() +
        "Exit code 0: compared; 1: a metric is above its limit (or undefined); 3: the images cannot be\n"
        "compared; 4: missing or unreadable; 6: compared, but some pixels are not finite numbers.");
    return [args](const Globals& globals) { return run_compare(*args, globals); };
}
}
