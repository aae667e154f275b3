#include "viewer/painting/reference_picture.h"

#include "base/text.h"
#include "measure/plan/terms.h"
#include "modes/mode.h"
#include "render/adaptive/candidates.h"
#include "render/frame/layers.h"
#include "trace/frame_cache.h"
#include "viewer/painting/request.h"
#include "viewer/state/setting_groups.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr double worth_saying = 5e-4; // the smallest bias that is mentioned

std::string bits_of(const Camera& camera) {
    CacheKey key;
    key.add(camera.position).add(camera.right).add(camera.up).add(camera.forward);
    key.add(camera.vertical_fov).add(camera.ortho_height).add(camera.near).add(camera.far);
    if (const Lens& lens = camera.lens) key.add(lens.radius).add(lens.focus).add(lens.blades).add(lens.rotation);
    return key.bits;
}

std::string key_of(const Request& request, const Settings& settings) {
    std::string key = formatted("%d %d %d %u %d ", request.frame, request.size.x, request.size.y, request.seed,
                                static_cast<int>(request.missing));
    for (const SettingGroup& group : setting_groups(main_mode()))
        for (const SettingRow* row : group.rows) key += row->get(settings) + " ";
    return key + bits_of(request.camera);
}

// Relative standard error of the mean of n samples, from halves of a and b samples whose RMS difference is d: the
// variance of a sample is d² / (1/a + 1/b).
double standard_error(const Image<vec3>& a, const Image<vec3>& b, std::array<int, 2> samples, double mean) {
    const double n = samples[0] + samples[1];
    const double part = std::sqrt(static_cast<double>(samples[0]) * samples[1]) / n;
    return relative(part * measure_errors(a, b).rmse, mean);
}

bool has_halves(const Rounds& rounds) { return rounds.half_samples[0] > 0 && rounds.half_samples[1] > 0; }

// Noise of the difference between a layer of an image and of the reference.
double noise_of(const Rounds& picture, const Rounds& reference, Image<vec3> ColorLayers::*layer, double mean) {
    const auto half = [&](size_t i) { return minus(picture.halves[i].*layer, reference.halves[i].*layer); };
    return standard_error(half(0), half(1), reference.half_samples, mean);
}

double mean_of(const Image<vec3>& image) { return measure_errors(image, image).mean_reference; }
}

Settings final_march(const Settings& settings) {
    Settings result = settings;
    take_rows(ladder_rows(main_mode()), settings_for(Quality::final), result);
    return result;
}

bool wants_reference(const Request& request) {
    return request.shown.layer == ShownLayer::error || request.beside == reference_name;
}

bool is_reference_of(const ReferencePicture& reference, const Request& request) {
    return reference.scene == request.scene && reference.edited == request.edited &&
           reference.key == key_of(request, final_march(request.settings));
}

void begin_reference(ReferencePicture& reference, const Request& request) {
    if (is_reference_of(reference, request)) return;
    reference = {};
    reference.scene = request.scene, reference.edited = request.edited;
    reference.settings = final_march(request.settings);
    reference.key = key_of(request, reference.settings);
}

bool is_finished(const ReferencePicture& reference, const Request& request) {
    return reference.rounds.samples >= request.max_samples && !reference.exact.color.empty();
}

namespace {
void add_difference(const Image<vec3>& exact, const Image<vec3>& coarse, Image<vec3>& image) {
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += exact.pixels[i] - coarse.pixels[i];
}

void make_exact(ReferencePicture& reference, const Request& request, const Snapshot& snapshot,
                std::atomic<bool>& cancel) {
    Rounds one;
    const Layers exact =
        render_round(one, main_mode(), request, truth_settings(request.settings), snapshot, 1, cancel).layers;
    const ColorLayers& coarse = reference.coarse;
    Layers result = reference.rounds.layers;
    add_difference(exact.color, coarse.color, result.color);
    add_difference(exact.inscatter, coarse.inscatter, result.inscatter);
    const auto share = [](const Errors& errors) { return relative(errors.rmse, errors.mean_reference); };
    reference.change = std::max(share(measure_errors(coarse.color, exact.color)),
                                share(measure_errors(coarse.inscatter, exact.inscatter)));
    reference.exact = std::move(result);
}
}

void paint_reference(ReferencePicture& reference, const Request& request, const Snapshot& snapshot, const Rounds& like,
                     std::atomic<bool>& cancel) {
    Rounds& rounds = reference.rounds;
    if (rounds.samples >= request.max_samples) return make_exact(reference, request, snapshot, cancel);
    const int samples = round_samples(rounds, request, &like);
    Round round = render_round(rounds, main_mode(), request, reference.settings, snapshot, samples, cancel);
    if (rounds.rounds == 0) reference.coarse = {round.layers.color, round.layers.inscatter};
    add_round(std::move(round), request, rounds);
}

ReferenceFacts facts_of(const ReferencePicture& reference, const Request& request) {
    ReferenceFacts facts;
    facts.samples = std::max(reference.rounds.samples, 1);
    facts.finished = is_finished(reference, request);
    const int orders = reference.settings.fluence.orders;
    facts.what = reference.exact.color.empty() ? "march at quality final" : "exact march";
    facts.what += orders > 1 ? formatted(", up to %d orders of scattering", orders) : ", single scattering";
    facts.change = reference.exact.color.empty() ? -1 : reference.change;
    const Rounds& rounds = reference.rounds;
    if (has_halves(rounds))
        facts.noise = standard_error(rounds.halves[0].inscatter, rounds.halves[1].inscatter, rounds.half_samples,
                                     mean_of(rounds.layers.inscatter));
    return facts;
}

ErrorFigures error_figures(const Rounds& picture, const ReferencePicture& reference) {
    const Layers& truth = layers_of(reference);
    Comparison comparison;
    comparison.beauty = measure_errors(picture.layers.color, truth.color);
    comparison.layers.emplace_back("inscatter", measure_errors(picture.layers.inscatter, truth.inscatter));
    const Errors &color = comparison.beauty, &fog = comparison.layers[0].second;
    ErrorFigures figures{comparison.worst_rmse(), relative(color.rmse, color.mean_reference),
                         relative(fog.rmse, fog.mean_reference), relative(color.bias, color.mean_reference)};
    if (has_halves(picture) && has_halves(reference.rounds))
        figures.noise = std::max(noise_of(picture, reference.rounds, &ColorLayers::color, color.mean_reference),
                                 noise_of(picture, reference.rounds, &ColorLayers::inscatter, fog.mean_reference));
    return figures;
}

std::string error_text(const ErrorFigures& errors) {
    std::string text = "rmse_rel " + percent_text(errors.worst);
    if (errors.noise >= 0) text += ", of which noise " + percent_text(std::min(errors.noise, errors.worst));
    text += "  \u00b7  image " + percent_text(errors.picture) + ", fog " + percent_text(errors.fog);
    if (std::abs(errors.bias) >= worth_saying)
        text += "  \u00b7  " + percent_text(std::abs(errors.bias)) + (errors.bias > 0 ? " too bright" : " too dark");
    return text;
}

std::string reference_text(const ReferenceFacts& facts) {
    std::string text = "reference: " + facts.what;
    text += formatted("  \u00b7  %d %s  \u00b7  ", facts.samples, facts.samples == 1 ? "sample" : "samples");
    if (facts.noise < 0) return text + "noise not yet known";
    text += "noise of the fog " + percent_text(facts.noise);
    return facts.finished ? text + formatted("  \u00b7  %s away from quality final", percent_text(facts.change).c_str())
                          : text + ", the exact image follows";
}

Image<glm::u8vec4> error_codes(const Layers& picture, const Layers& reference) {
    const Image<float> errors = error_map(picture.color, reference.color, mean_of(reference.color));
    Image<glm::u8vec4> codes(errors.size);
    for (size_t i = 0; i < codes.pixels.size(); ++i) codes.pixels[i] = {heat_color(errors.pixels[i], error_scale), 255};
    return codes;
}
}
