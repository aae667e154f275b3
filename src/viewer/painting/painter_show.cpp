// Composes the shown image from a painter's layers: the requested layer, two images in one, errors, answers.
#include "viewer/painting/painter_show.h"
#include "base/clock.h"
#include "modes/history.h"
#include "modes/mode.h"
#include "render/sequence/auto_exposure.h"
#include "render/sequence/job.h"

#include <algorithm>

namespace tyndall {
namespace {

constexpr glm::u8vec4 nothing_yet(12, 12, 13, 255);

bool asks_for_volume(const Painter& painter, const Request& request) {
    const VolumePicture* last = painter.volume.get();
    return request.volume && !(last && last->revision == request.revision && last->question == *request.volume &&
                               (request.moving || !last->quick));
}

// The reference so far, if it is shown and matches this image's size; else null.
const ReferencePicture* shown_reference(const Painter& painter, const Request& request) {
    const Rounds& rounds = painter.reference.rounds;
    const bool there = wants_reference(request) && rounds.rounds > 0 && is_reference_of(painter.reference, request);
    return there && rounds.layers.size == painter.rounds[0].layers.size ? &painter.reference : nullptr;
}

// Display codes of the layer shown of a mode's image, and its errors if that layer shows them.
Image<glm::u8vec4> codes_of(const Rounds& rounds, const ReferencePicture* reference, const Request& request,
                            std::optional<ErrorFigures>& errors) {
    errors.reset();
    if (request.shown.layer != ShownLayer::error || !reference) return tone_map(rounds.layers, request.shown);
    errors = error_figures(rounds, *reference);
    return error_codes(rounds.layers, layers_of(*reference));
}

// Combines two images into one: the right one from the wipe on, or both in full side by side.
void put_beside(const Image<glm::u8vec4>& right, const DisplayOptions& shown, Image<glm::u8vec4>& codes) {
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
}

const Mode* mode_beside(const Request& request) {
    return request.beside.empty() || request.beside == reference_name ? nullptr : &find_mode(request.beside);
}

bool is_finished(const Painter& painter, const Request& request) {
    if (asks_for_volume(painter, request)) return false;
    const int wanted = request.max_samples;
    if (asks_for_ray(request, painter.ray.get())) return false;
    if (painter.rounds[0].samples < wanted || (mode_beside(request) && painter.rounds[1].samples < wanted))
        return false;
    return !wants_reference(request) ||
           (is_reference_of(painter.reference, request) && is_finished(painter.reference, request));
}

std::shared_ptr<const PixelValues> values_of(const Layers& layers) {
    return std::make_shared<const PixelValues>(PixelValues{layers.color, layers.depth});
}

// The request with an exposure: the one already measured, or measured here.
Request exposed(Painter& painter, Request request) {
    if (request.shown.exposure) return request;
    if (painter.metering_id != request.metering_id || painter.measured.lock() != request.scene) {
        const int orders = orders_of(find_mode(request.mode), request.settings);
        painter.exposure =
            automatic_exposure(*request.scene, render_request(request), orders, &painter.snapshot, &request.camera);
        painter.metering_id = request.metering_id, painter.measured = request.scene;
    }
    request.shown.exposure = painter.exposure;
    return request;
}

ShownPicture shown(Painter& painter, const Request& asked) {
    const double start = steady_seconds();
    const Request request = exposed(painter, asked);
    ShownPicture picture = painter.picture;
    picture.exposure = *request.shown.exposure, picture.metering_id = request.metering_id;
    picture.measured.reset();
    if (!asked.shown.exposure) picture.measured = picture.exposure;
    if (request.explain) picture.ray = painter.ray;
    if (request.volume && asks_for_volume(painter, request) &&
        !(picture.quick && request.volume->look != VolumeLook::slice))
        painter.volume = volume_picture(request, painter.snapshot, painter.known_volumes);
    if (request.volume) picture.volume = painter.volume;
    const ReferencePicture* reference = picture.quick ? nullptr : shown_reference(painter, request);
    if (reference) picture.reference = facts_of(painter.reference, request);
    picture.codes = codes_of(painter.rounds[0], reference, request, picture.errors);
    picture.values = values_of(painter.rounds[0].layers);
    if (!request.beside.empty()) {
        Image<glm::u8vec4> right;
        if (!picture.quick && !mode_beside(request) && reference)
            right = tone_map(layers_of(*reference), request.shown), picture.beside = reference_name,
            picture.values_beside = values_of(layers_of(*reference));
        else if (!picture.quick && painter.rounds[1].rounds > 0)
            right = codes_of(painter.rounds[1], reference, request, picture.errors_beside),
            picture.beside = request.beside, picture.values_beside = values_of(painter.rounds[1].layers);
        put_beside(right, request.shown, picture.codes);
        picture.across = request.shown.side_by_side ? 2 : 1;
    }
    picture.finished = !picture.quick && is_finished(painter, request);
    picture.times.tone = painter.picture.times.tone = steady_seconds() - start;
    return picture;
}
}
