#include "viewer/painting/painter.h"

#include "base/clock.h"
#include "base/error.h"
#include "modes/history.h"
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "trace/frame_cache.h"
#include "trace/lights/enclosed_lights.h"
#include "viewer/painting/painter_show.h"

#include <algorithm>
#include <new>

namespace tyndall {
namespace {

// Loads the scene at the request's frame. Static data is shared with the previous image.
void load(Painter& painter, const Request& request) {
    const double start = steady_seconds();
    double ahead_seconds = 0;
    for (Rounds& rounds : painter.rounds) rounds.prepared = nullptr;
    painter.reference.rounds.prepared = nullptr;
    const bool same_scene = painter.scene == request.scene, same_edits = painter.edited == request.edited;
    const bool same_files = painter.request.missing == request.missing;
    if (same_scene && same_edits && same_files && painter.snapshot.frame == request.frame && painter.snapshot.cache) {
        painter.snapshot.previous_cache = std::exchange(painter.snapshot.cache, std::make_shared<FrameCache>());
        painter.snapshot.notes.clear();
    } else {
        if (!same_scene) painter.history = {};
        if (same_scene && !same_edits) set_extent(*request.scene, painter.snapshot);
        painter.store.begin(request.scene, request.missing);
        if (!same_edits) painter.store.clear();
        if (same_files && same_edits) painter.store.put(painter.snapshot);
        std::optional<Snapshot> stored = painter.store.take(request.frame, ahead_seconds);
        painter.snapshot = stored ? std::move(*stored)
                                  : make_snapshot(*request.scene, moment_of(*request.scene, request.frame),
                                                  same_scene ? &painter.snapshot : nullptr, request.missing);
        painter.scene = request.scene, painter.edited = request.edited;
    }
    painter.picture.times.load = steady_seconds() - start + ahead_seconds;
    painter.picture.notes = painter.snapshot.notes;
    if (!same_scene)
        for (std::string& line : enclosed_lights(painter.snapshot)) painter.picture.notes.push_back(std::move(line));
}

void note_times(Painter& painter, const FrameStats& stats) {
    StageTimes& times = painter.picture.times;
    times.prepare = stats.prepare_seconds, times.render = stats.render_seconds, times.fog = stats.fog_seconds;
}

// One sample per pixel of the quick mode.
Layers render_quick(Painter& painter, const Request& request, float scale, std::atomic<bool>& cancel) {
    View view = view_of(request);
    view.size = glm::min(glm::max(ivec2(glm::round(vec2(view.size) * scale)), ivec2(8)), view.size);
    view.pixel_samples = view.lamp_samples = view.edge_samples = 1;
    view.frame = painter.ticks++;
    const Mode& mode = find_mode(quick_mode(request));
    FrameStats stats;
    FrameOptions options;
    options.cancel = &cancel;
    if (mode.uses_history) options.history = &painter.history;
    Layers layers = render_frame(mode, view, painter.snapshot, request.settings, options, stats);
    note_times(painter, stats);
    painter.picture.mode = mode.name, painter.picture.samples = 1, painter.picture.non_finite = stats.non_finite;
    return layers;
}

ShownPicture paint_quick(Painter& painter, const Request& request, std::atomic<bool>& cancel) {
    Pace& pace = painter.paces[quick_mode(request)];
    pace.wanted = request.wanted_seconds;
    painter.rounds[0].layers = render_quick(painter, request, pace.scale(), cancel);
    painter.quick = true, painter.stood_in = pace.level == 0;
    painter.picture.quick = true;
    ShownPicture picture = shown(painter, request);
    const StageTimes& times = picture.times;
    update_pace(pace, times.total(), times.load + times.prepare);
    return picture;
}

ShownPicture paint_stand_in(Painter& painter, const Request& request, std::atomic<bool>& cancel) {
    painter.rounds[0].layers = render_quick(painter, request, 1, cancel);
    painter.stood_in = true;
    painter.picture.quick = false;
    return shown(painter, request);
}

// The mode's limitations in this view, worst first.
std::vector<LimitationGroup> limitations_of(const Painter& painter, const Request& request) {
    const Mode& mode = find_mode(request.mode);
    auto groups = groups_of(mode.limitations(view_of(request), painter.snapshot, request.settings));
    std::ranges::stable_sort(groups, std::ranges::greater(), [](const auto& group) { return group.worst.severity; });
    return groups;
}

// Which gets the next round: of those not finished, the one with the fewest rounds.
enum class Turn { mode, beside, reference };

Turn next_turn(const Painter& painter, const Request& request) {
    Turn turn = wants_reference(request) ? Turn::reference : Turn::mode;
    int fewest = std::numeric_limits<int>::max();
    const auto consider = [&](Turn whose, const Rounds& rounds) {
        if (rounds.samples < request.max_samples && rounds.rounds < fewest) turn = whose, fewest = rounds.rounds;
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

    if (!right && rounds.rounds == 0) picture.limitations = limitations_of(painter, request), picture.non_finite = 0;
    picture.non_finite += round.stats.non_finite;
    add_round(std::move(round), request, rounds);
    picture.mode = request.mode, picture.quick = false;
    const int samples = mode_beside(request) ? std::min(painter.rounds[0].samples, painter.rounds[1].samples)
                                             : painter.rounds[0].samples;
    picture.samples = std::max(samples, 1);
    return shown(painter, request);
}

// Discards the previous image and starts a new one.
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
    apply_edits(request);
    if (!same) begin(painter, request);
    painter.request = request;
    // Until this image has started, the layers belong to another one.
    if (shown_anew && !painter.picture.mode.empty()) return shown(painter, request);
    if (request.moving) {
        // A still image that has started is better than a quick one.
        if (!painter.quick && painter.rounds[0].rounds == 0) return paint_quick(painter, request, cancel);
        if (request.next_frame) painter.store.prefetch(*request.next_frame, painter.snapshot);
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
    } catch (const std::exception& error) {
        return failed(request, error.what(), ExitCode::internal);
    }
}
}
