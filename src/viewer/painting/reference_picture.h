// What pictures are held against while they are looked at: the exact march of the same view, kept for as long as what
// it shows stands still. Its samples lie where those of the picture beside it do, so that edges do not count as errors.
//
// The exact march is slow, and hardly off from the march of quality final. So many samples are those of the latter, and
// what one sample of both at each pixel's middle differs by is added at the end (two levels: Giles 2008).
#pragma once
#include "measure/metrics/comparison.h"
#include "measure/metrics/heatmap.h"
#include "viewer/painting/rounds.h"
#include "viewer/painting/shown_picture.h"

namespace tyndall {
struct EditableParts;

inline constexpr std::string_view reference_name = "reference"; // beside a mode, instead of another one
inline constexpr HeatScale error_scale{1e-3, 1, true};          // of the reference's mean

struct ReferencePicture {
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const EditableParts> edited;
    std::string key;   // of all it depends on
    Settings settings; // of quality final
    Rounds rounds;
    ColorLayers look;  // one sample at pixels' middles
    Layers exact;      // in the end
    double change = 0; // that made, a share of the mean
};

// The picture's light and pixels with the march's rows of quality final.
Settings final_march(const Settings& settings);

// Whether the request shows a reference, or errors against one.
bool wants_reference(const Request& request);

// Whether the reference is the one of this request.
bool is_reference_of(const ReferencePicture& reference, const Request& request);

// Begins anew unless the reference is the one of this request already.
void begin_reference(ReferencePicture& reference, const Request& request);

bool is_finished(const ReferencePicture& reference, const Request& request);

// One more round, as the picture's rounds were made; after the last, the step to the exact march.
void paint_reference(ReferencePicture& reference, const Request& request, const Snapshot& snapshot, const Rounds& like,
                     std::atomic<bool>& cancel);

// As far as it has got.
inline const Layers& layers_of(const ReferencePicture& reference) {
    return reference.exact.color.empty() ? reference.rounds.layers : reference.exact;
}

// What it is, and the standard error of its fog light as a share of the mean, from the difference of its halves: edges
// of surfaces are as rough in the pictures held against it.
ReferenceFacts facts_of(const ReferencePicture& reference, const Request& request);

// How far a picture is from it. The noise is that of their difference, from the halves of both.
ErrorFigures error_figures(const Rounds& picture, const ReferencePicture& reference);

// "rmse_rel 3.1 % · picture 2.0 %, fog 3.1 % · 1.2 % too bright".
std::string error_text(const ErrorFigures& errors);

// What the reference is, how far it has got and how noisy it still is.
std::string reference_text(const ReferenceFacts& facts);

// Each pixel's difference in the colour of error_scale; bright green where it is no number.
Image<glm::u8vec4> error_codes(const Layers& picture, const Layers& reference);
}
