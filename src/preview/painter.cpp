#include "preview/painter.h"

#include "base/error.h"
#include "base/random.h"
#include "render/layers_mean.h"
#include "render/provenance.h"

#include <algorithm>
#include <chrono>
#include <new>

namespace tyndall {
const std::string& quick_mode(const Request& request) {
    const bool slow = request.mode == "march" || request.mode == "path";
    return slow && !request.stand_in.empty() ? request.stand_in : request.mode;
}

RenderJob job_of(const Request& request) {
    RenderJob job;
    job.frames = {request.frame};
    job.mode = request.mode, job.settings = request.settings;
    job.resolution = request.size, job.seed = request.seed, job.missing = request.missing;
    if (request.scene) job.scene_file = request.scene->file;
    return job;
}

View view_of(const Request& request) {
    View view = view_of(*request.scene, job_of(request), request.frame);
    view.camera = request.camera;
    return view;
}

void stage(const Request& request) {
    if (request.edited) put_parts(*request.edited, *request.scene);
}

namespace {
using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr double longest_round = 0.4; // seconds; the picture is renewed at least as often
constexpr int most_round_samples = 8;

// The scene at the request's moment. What stands still is shared with the picture before.
void load(Painter& painter, const Request& request) {
    const auto start = Clock::now();
    for (Rounds& rounds : painter.rounds) rounds.prepared = nullptr;
    const bool same_scene = painter.scene == request.scene, same_edits = painter.edited == request.edited;
    if (same_scene && same_edits && painter.snapshot.frame == request.frame && painter.snapshot.kept) {
        painter.snapshot.kept_before = std::exchange(painter.snapshot.kept, std::make_shared<Kept>());
        painter.snapshot.notes.clear();
    } else {
        if (!same_scene) painter.history = {};
        painter.snapshot = make_snapshot(*request.scene, moment_of(*request.scene, request.frame),
                                         same_scene ? &painter.snapshot : nullptr, request.missing);
        painter.scene = request.scene, painter.edited = request.edited;
    }
    painter.picture.times.load = seconds_since(start);
    painter.picture.notes = painter.snapshot.notes;
}

// Codes of both modes, side by side.
ShownPicture shown(Painter& painter, const Request& request) {
    const auto start = Clock::now();
    ShownPicture picture = painter.picture;
    picture.codes = toned(painter.rounds[0].layers, request.shown);
    if (!picture.beside.empty()) {
        const Image<glm::u8vec4> right = toned(painter.rounds[1].layers, request.shown);
        const float width = static_cast<float>(right.size.x);
        const int split = static_cast<int>(std::round(std::clamp(request.shown.wipe, 0.0f, 1.0f) * width));
        for (int y = 0; y < right.size.y; ++y)
            for (int x = split; x < right.size.x; ++x) picture.codes.at(x, y) = right.at(x, y);
    }
    picture.times.tone = painter.picture.times.tone = seconds_since(start);
    return picture;
}

void note_times(Painter& painter, const FrameStats& stats) {
    StageTimes& times = painter.picture.times;
    times.prepare = stats.prepare_seconds, times.render = stats.render_seconds, times.fog = stats.fog_seconds;
}

// One ray a pixel of the quick mode.
Layers render_quick(Painter& painter, const Request& request, float share, std::atomic<bool>& cancel) {
    View view = view_of(request);
    view.size = glm::max(ivec2(glm::round(vec2(view.size) * share)), ivec2(8));
    view.pixel_samples = view.lamp_samples = view.edge_samples = 1;
    view.frame = painter.ticks++;
    const Mode& mode = find_mode(quick_mode(request));
    FrameStats stats;
    FrameOptions options;
    options.cancel = &cancel;
    if (mode.remembers) options.history = &painter.history;
    Layers layers = render_frame(mode, view, painter.snapshot, request.settings, options, stats);
    note_times(painter, stats);
    painter.picture.mode = mode.name, painter.picture.samples = 1, painter.picture.non_finite = stats.non_finite;
    return layers;
}

ShownPicture paint_quick(Painter& painter, const Request& request, std::atomic<bool>& cancel) {
    Pace& pace = painter.paces[quick_mode(request)];
    pace.wanted = request.wanted_seconds;
    painter.rounds[0].layers = render_quick(painter, request, pace.share(), cancel);
    painter.quick = true, painter.stood_in = pace.level == 0;
    painter.picture.quick = true, painter.picture.finished = false;
    ShownPicture picture = shown(painter, request);
    const StageTimes& times = picture.times;
    measured(pace, times.total(), times.load + times.prepare);
    return picture;
}

ShownPicture paint_stand_in(Painter& painter, const Request& request, std::atomic<bool>& cancel) {
    painter.rounds[0].layers = render_quick(painter, request, 1, cancel);
    painter.stood_in = true;
    painter.picture.quick = painter.picture.finished = false;
    return shown(painter, request);
}

// Samples of the next round: first one for a look, then as many as the settings say, which makes the picture that
// tyndall render makes, then about as many as there are. Rounds are over soon, but for the first two; one sample alone
// would always lie in the middle of its pixel.
int round_samples(const Rounds& rounds, const Request& request) {
    if (rounds.rounds == 0) return 1;
    const int left = request.most_samples - rounds.samples;
    if (rounds.samples == 0) return std::min(request.settings.pixel.samples, left);
    const double in_time = std::max(longest_round / std::max(rounds.sample_seconds, 1e-6), 2.0);
    const int samples = std::min(std::clamp(rounds.samples, 4, most_round_samples), static_cast<int>(in_time));
    return left - samples < 2 ? left : samples;
}

// What the mode gets wrong here, worst first.
std::vector<Limit> limits_of(const Painter& painter, const Request& request) {
    std::vector<Limit> limits = find_mode(request.mode).limits(view_of(request), painter.snapshot, request.settings);
    std::ranges::stable_sort(limits, std::ranges::greater(), &Limit::severity);
    return limits;
}

// What a mode prepares serves all rounds, unless it is a part of the picture's noise.
void prepare(const Painter& painter, const Mode& mode, const View& view, Rounds& rounds, FrameOptions& options,
             FrameStats& stats) {
    if (mode.remembers) return;
    if (!rounds.prepared) {
        const auto start = Clock::now();
        rounds.prepared = std::make_shared<const Prepared>(
            prepare_frame(mode, view, painter.snapshot, painter.request.settings, nullptr));
        stats.prepare_seconds = seconds_since(start), stats.fog_seconds = rounds.prepared->mode_seconds;
    }
    options.prepared = rounds.prepared;
}

// A round into the mean of all; what was shown for a first look is replaced.
void add_round(Layers layers, const FrameStats& stats, const Request& request, Rounds& rounds) {
    if (rounds.samples == 0) {
        rounds.layers = std::move(layers);
    } else {
        const float all = static_cast<float>(rounds.samples + stats.samples);
        blend_layers(rounds.layers, layers, static_cast<float>(stats.samples) / all);
    }
    if (rounds.rounds > 0 || request.most_samples == 1) rounds.samples += stats.samples;
    ++rounds.rounds;
}

// One round of the mode asked for or of the one beside, whichever has had fewer.
ShownPicture paint_round(Painter& painter, const Request& request, std::atomic<bool>& cancel) {
    const bool two = !request.beside.empty();
    const bool right = two && painter.rounds[1].rounds < painter.rounds[0].rounds;
    Rounds& rounds = painter.rounds[right];
    const Mode& mode = find_mode(right ? request.beside : request.mode);
    View view = view_of(request);
    view.pixel_samples = round_samples(rounds, request);
    if (rounds.samples > 0) view.seed = hash(view.seed, static_cast<uint32_t>(rounds.rounds));
    FrameStats preparing, stats;
    FrameOptions options;
    options.cancel = &cancel;
    prepare(painter, mode, view, rounds, options, preparing);
    Layers layers = render_frame(mode, view, painter.snapshot, request.settings, options, stats);
    rounds.sample_seconds = stats.render_seconds / stats.samples;
    stats.prepare_seconds += preparing.prepare_seconds, stats.fog_seconds += preparing.fog_seconds;
    note_times(painter, stats);

    ShownPicture& picture = painter.picture;
    if (!right && rounds.rounds == 0) picture.limits = limits_of(painter, request), picture.non_finite = 0;
    add_round(std::move(layers), stats, request, rounds);
    picture.non_finite += stats.non_finite;
    picture.mode = request.mode, picture.quick = false;
    picture.beside = painter.rounds[1].rounds > 0 ? request.beside : "";
    const int samples = two ? std::min(painter.rounds[0].samples, painter.rounds[1].samples) : rounds.samples;
    picture.samples = std::max(samples, 1), picture.finished = samples >= request.most_samples;
    return shown(painter, request);
}

bool is_finished(const Painter& painter, const Request& request) {
    const bool two = !request.beside.empty();
    return std::min(painter.rounds[0].samples, painter.rounds[two].samples) >= request.most_samples;
}

// Forgets the picture before.
void begin(Painter& painter, const Request& request) {
    painter.begun = false;
    painter.picture = {};
    painter.picture.revision = request.revision, painter.picture.frame = request.frame;
    painter.picture.wanted = request.size;
    painter.quick = painter.stood_in = false;
    // The layers stay until others are there.
    for (Rounds& rounds : painter.rounds) rounds = {nullptr, std::move(rounds.layers), 0, 0, 0};
    load(painter, request);
    painter.begun = true;
}

std::optional<ShownPicture> next_picture(Painter& painter, const Request& request, std::atomic<bool>& cancel) {
    const bool same = painter.begun && painter.request.revision == request.revision;
    const bool shown_anew = same && painter.request.shown_revision != request.shown_revision;
    painter.request = request;
    stage(request);
    if (!same) begin(painter, request);
    if (shown_anew && !painter.rounds[0].layers.color.empty()) return shown(painter, request);
    if (request.moving && !painter.quick) return paint_quick(painter, request, cancel);
    if (request.moving) return {};
    if (painter.rounds[0].rounds == 0 && !painter.stood_in && quick_mode(request) != request.mode)
        return paint_stand_in(painter, request, cancel);
    if (is_finished(painter, request)) return {};
    return paint_round(painter, request, cancel);
}

ShownPicture failed(const Request& request, const std::string& why, ExitCode code) {
    ShownPicture picture;
    picture.revision = request.revision, picture.frame = request.frame, picture.wanted = request.size;
    picture.finished = true, picture.error = why, picture.code = code;
    return picture;
}
}

std::optional<ShownPicture> paint(Painter& painter, const Request& request, std::atomic<bool>& cancel) {
    try {
        return next_picture(painter, request, cancel);
    } catch (const Error& error) {
        if (cancel) return {};
        return failed(request, error.what(), error.code);
    } catch (const std::bad_alloc&) {
        return failed(request, "out of memory", ExitCode::out_of_memory);
    }
}
}
