#include "preview/painter.h"

#include "base/error.h"
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

constexpr glm::u8vec4 nothing_yet(12, 12, 13, 255);

// The mode of the right part; null when there is none, or the reference.
const Mode* mode_beside(const Request& request) {
    return request.beside.empty() || request.beside == reference_name ? nullptr : &find_mode(request.beside);
}

// The scene at the request's moment. What stands still is shared with the picture before.
void load(Painter& painter, const Request& request) {
    const auto start = Clock::now();
    double ahead_seconds = 0;
    for (Rounds& rounds : painter.rounds) rounds.prepared = nullptr;
    painter.reference.rounds.prepared = nullptr;
    const bool same_scene = painter.scene == request.scene, same_edits = painter.edited == request.edited;
    const bool same_files = painter.request.missing == request.missing;
    if (same_scene && same_edits && same_files && painter.snapshot.frame == request.frame && painter.snapshot.kept) {
        painter.snapshot.kept_before = std::exchange(painter.snapshot.kept, std::make_shared<Kept>());
        painter.snapshot.notes.clear();
    } else {
        if (!same_scene) painter.history = {};
        painter.store.begin(request.scene, request.missing);
        if (!same_edits) painter.store.clear();
        if (same_files && same_edits) painter.store.put(painter.snapshot);
        std::optional<Snapshot> stored = painter.store.take(request.frame, ahead_seconds);
        painter.snapshot = stored ? std::move(*stored)
                                  : make_snapshot(*request.scene, moment_of(*request.scene, request.frame),
                                                  same_scene ? &painter.snapshot : nullptr, request.missing);
        painter.scene = request.scene, painter.edited = request.edited;
    }
    painter.picture.times.load = seconds_since(start) + ahead_seconds;
    painter.picture.notes = painter.snapshot.notes;
}

bool asks_for_volume(const Painter& painter, const Request& request) {
    const VolumePicture* last = painter.volume.get();
    return request.volume && !(last && last->revision == request.revision && last->question == *request.volume &&
                               (request.moving || !last->quick));
}

bool is_finished(const Painter& painter, const Request& request) {
    if (asks_for_volume(painter, request)) return false;
    const int wanted = request.most_samples;
    if (asks_for_ray(request, painter.ray.get())) return false;
    if (painter.rounds[0].samples < wanted || (mode_beside(request) && painter.rounds[1].samples < wanted))
        return false;
    return !wants_reference(request) ||
           (is_reference_of(painter.reference, request) && is_finished(painter.reference, request));
}

// The reference of a picture of this size, as far as it has got and is shown.
const ReferencePicture* shown_reference(const Painter& painter, const Request& request) {
    const Rounds& rounds = painter.reference.rounds;
    const bool there = wants_reference(request) && rounds.rounds > 0 && is_reference_of(painter.reference, request);
    return there && rounds.layers.size == painter.rounds[0].layers.size ? &painter.reference : nullptr;
}

// What of a mode's picture is shown, and its errors where these are.
Image<glm::u8vec4> codes_of(const Rounds& rounds, const ReferencePicture* reference, const Request& request,
                            std::optional<ErrorFigures>& errors) {
    errors.reset();
    if (request.shown.layer != ShownLayer::error || !reference) return toned(rounds.layers, request.shown);
    errors = error_figures(rounds, *reference);
    return error_codes(rounds.layers, layers_of(*reference));
}

// Two pictures as one: the right one from the wipe on, or both whole beside each other.
void put_beside(const Image<glm::u8vec4>& right, const Shown& shown, Image<glm::u8vec4>& codes) {
    const ivec2 size = codes.size;
    const int shift = shown.side_by_side ? size.x : 0;
    int split = static_cast<int>(std::round(std::clamp(shown.wipe, 0.0f, 1.0f) * static_cast<float>(size.x)));
    if (shown.side_by_side) {
        Image<glm::u8vec4> both({2 * size.x, size.y}, nothing_yet);
        for (int y = 0; y < size.y; ++y) std::copy_n(&codes.at(0, y), static_cast<size_t>(size.x), &both.at(0, y));
        codes = std::move(both), split = 0;
    }
    if (right.size != size || split == size.x) return;
    for (int y = 0; y < size.y; ++y)
        std::copy_n(&right.at(split, y), static_cast<size_t>(size.x - split), &codes.at(shift + split, y));
}

// Codes of what the request shows.
ShownPicture shown(Painter& painter, const Request& request) {
    const auto start = Clock::now();
    ShownPicture picture = painter.picture;
    if (request.explain) picture.ray = painter.ray;
    if (request.volume && asks_for_volume(painter, request) &&
        !(picture.quick && request.volume->look != VolumeLook::slice))
        painter.volume = volume_picture(request, painter.snapshot, painter.known_volumes);
    if (request.volume) picture.volume = painter.volume;
    const ReferencePicture* reference = picture.quick ? nullptr : shown_reference(painter, request);
    if (reference) picture.reference = facts_of(painter.reference, request);
    picture.codes = codes_of(painter.rounds[0], reference, request, picture.errors);
    if (!request.beside.empty()) {
        Image<glm::u8vec4> right;
        if (!picture.quick && !mode_beside(request) && reference)
            right = toned(layers_of(*reference), request.shown), picture.beside = reference_name;
        else if (!picture.quick && painter.rounds[1].rounds > 0)
            right = codes_of(painter.rounds[1], reference, request, picture.errors_beside),
            picture.beside = request.beside;
        put_beside(right, request.shown, picture.codes);
        picture.across = request.shown.side_by_side ? 2 : 1;
    }
    picture.finished = !picture.quick && is_finished(painter, request);
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
    view.size = glm::min(glm::max(ivec2(glm::round(vec2(view.size) * share)), ivec2(8)), view.size);
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
    painter.picture.quick = true;
    ShownPicture picture = shown(painter, request);
    const StageTimes& times = picture.times;
    measured(pace, times.total(), times.load + times.prepare);
    return picture;
}

ShownPicture paint_stand_in(Painter& painter, const Request& request, std::atomic<bool>& cancel) {
    painter.rounds[0].layers = render_quick(painter, request, 1, cancel);
    painter.stood_in = true;
    painter.picture.quick = false;
    return shown(painter, request);
}

// What the mode gets wrong here, worst first.
std::vector<Limit> limits_of(const Painter& painter, const Request& request) {
    std::vector<Limit> limits = find_mode(request.mode).limits(view_of(request), painter.snapshot, request.settings);
    std::ranges::stable_sort(limits, std::ranges::greater(), &Limit::severity);
    return limits;
}

// Whose round comes next: of those that are not finished, the one that has had the fewest.
enum class Turn { mode, beside, reference };

Turn next_turn(const Painter& painter, const Request& request) {
    Turn turn = wants_reference(request) ? Turn::reference : Turn::mode;
    int fewest = std::numeric_limits<int>::max();
    const auto consider = [&](Turn whose, const Rounds& rounds) {
        if (rounds.samples < request.most_samples && rounds.rounds < fewest) turn = whose, fewest = rounds.rounds;
    };
    consider(Turn::mode, painter.rounds[0]);
    if (mode_beside(request)) consider(Turn::beside, painter.rounds[1]);
    if (wants_reference(request)) consider(Turn::reference, painter.reference.rounds);
    return turn;
}

ShownPicture paint_round(Painter& painter, const Request& request, std::atomic<bool>& cancel) {
    const bool against = wants_reference(request);
    if (against) begin_reference(painter.reference, request);
    ShownPicture& picture = painter.picture;
    const Turn turn = next_turn(painter, request);
    if (turn == Turn::reference) {
        paint_reference(painter.reference, request, painter.snapshot, painter.rounds[0], cancel);
        return shown(painter, request);
    }
    const bool right = turn == Turn::beside;
    Rounds& rounds = painter.rounds[right];
    const Mode& mode = right ? *mode_beside(request) : find_mode(request.mode);
    const int count = round_samples(rounds, request, against ? &painter.reference.rounds : nullptr);
    Round round = render_round(rounds, mode, request, request.settings, painter.snapshot, count, cancel);
    note_times(painter, round.stats);

    if (!right && rounds.rounds == 0) picture.limits = limits_of(painter, request), picture.non_finite = 0;
    picture.non_finite += round.stats.non_finite;
    add_round(std::move(round), request, rounds);
    picture.mode = request.mode, picture.quick = false;
    const int samples = mode_beside(request) ? std::min(painter.rounds[0].samples, painter.rounds[1].samples)
                                             : painter.rounds[0].samples;
    picture.samples = std::max(samples, 1);
    return shown(painter, request);
}

// Forgets the picture before.
void begin(Painter& painter, const Request& request) {
    painter.begun = false;
    painter.picture = {};
    painter.picture.revision = request.revision, painter.picture.frame = request.frame;
    painter.picture.wanted = request.size;
    painter.quick = painter.stood_in = false;
    for (Rounds& rounds : painter.rounds) rounds.forget();
    load(painter, request);
    painter.begun = true;
}

std::optional<ShownPicture> next_picture(Painter& painter, const Request& request, std::atomic<bool>& cancel) {
    const bool same = painter.begun && painter.request.revision == request.revision;
    const bool shown_anew = same && painter.request.shown_revision != request.shown_revision;
    stage(request);
    if (!same) begin(painter, request);
    painter.request = request;
    // Until this picture has begun, the layers are those of another.
    if (shown_anew && !painter.picture.mode.empty()) return shown(painter, request);
    if (request.moving) {
        // A still picture that has begun is better than a quick one.
        if (!painter.quick && painter.rounds[0].rounds == 0) return paint_quick(painter, request, cancel);
        if (request.next_frame) painter.store.make_ahead(*request.next_frame, painter.snapshot);
        return {};
    }
    if (painter.rounds[0].rounds == 0 && !painter.stood_in && quick_mode(request) != request.mode)
        return paint_stand_in(painter, request, cancel);
    if (is_finished(painter, request)) return {};
    if (painter.rounds[0].rounds > 0 && asks_for_ray(request, painter.ray.get())) {
        painter.ray = answer_ray(request, painter.snapshot, painter.ray.get(), cancel);
        return shown(painter, request);
    }
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
