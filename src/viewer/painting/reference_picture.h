// The reference that images are compared with in the viewer: the exact march of the same view, kept as long as nothing
// in it changes. Its samples lie where those of the image do, so that edges do not count as errors.
//
// The exact march is slow, and differs little from the march of quality final. Most samples are therefore of the
// latter, and the difference between the two for one sample at each pixel's center is added at the end (two levels:
// Giles 2008).
#pragma once
#include "measure/metrics/comparison.h"
#include "measure/metrics/heatmap.h"
#include "viewer/painting/rounds.h"
#include "viewer/painting/shown_picture.h"

namespace tyndall {
struct EditableParts;

inline constexpr std::string_view reference_name = "reference"; // name used in place of a comparison mode
inline constexpr HeatScale error_scale{1e-3, 1, true};          // relative to the reference's mean

struct ReferencePicture {
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const EditableParts> edited;
    std::string key;   // of all it depends on
    Settings settings; // of quality final
    Rounds rounds;
    ColorLayers coarse; // one sample at pixel centers
    Layers exact;       // the final result
    double change = 0;  // caused by the exact march, relative to the mean
};

// The image's settings for light and pixels, with the march's settings of quality final.
Settings final_march(const Settings& settings);

// Whether the request shows a reference, or errors relative to one.
bool wants_reference(const Request& request);

// Whether the reference is the one of this request.
bool is_reference_of(const ReferencePicture& reference, const Request& request);

// Restarts the reference unless it is already the one of this request.
void begin_reference(ReferencePicture& reference, const Request& request);

bool is_finished(const ReferencePicture& reference, const Request& request);

// Adds a round with the same number of samples as the image's; after the last, adds the difference to the exact march.
void paint_reference(ReferencePicture& reference, const Request& request, const Snapshot& snapshot, const Rounds& like,
                     std::atomic<bool>& cancel);

// The reference so far.
inline const Layers& layers_of(const ReferencePicture& reference) {
    return reference.exact.color.empty() ? reference.rounds.layers : reference.exact;
}

// Describes the reference, with the standard error of its fog light relative to the mean, from the difference of its
// halves. Surface edges are excluded: they are as noisy in the images compared with it.
ReferenceFacts facts_of(const ReferencePicture& reference, const Request& request);

// The errors of an image relative to the reference. The noise is that of their difference, from the halves of both.
ErrorFigures error_figures(const Rounds& picture, const ReferencePicture& reference);

// "rmse_rel 3.1 % · image 2.0 %, fog 3.1 % · 1.2 % too bright".
std::string error_text(const ErrorFigures& errors);

// Describes the reference, its progress and its remaining noise.
std::string reference_text(const ReferenceFacts& facts);

// Each pixel's error in the colors of error_scale; bright green if it is not a number.
Image<glm::u8vec4> error_codes(const Layers& picture, const Layers& reference);
}
