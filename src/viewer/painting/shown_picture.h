// An image from the render thread, ready to be shown.
#pragma once
#include "base/error.h"
#include "base/image.h"
#include "modes/limitation.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tyndall {
struct RayAnswer;
struct VolumePicture;

struct StageTimes {
    double load = 0;    // the snapshot: animation, fog, ray tracing structures
    double prepare = 0; // the mode's work before its first ray
    double fog = 0;     // the mode's part of prepare and render
    double render = 0;
    double tone = 0;
    double total() const { return load + prepare + render + tone; }
};

// About the reference that an image is compared with.
struct ReferenceFacts {
    std::string what; // "exact march, single scattering"
    int samples = 0;  // per pixel so far
    bool finished = false;
    double change = -1; // relative, by the step from quality final to the exact march; negative: not made yet
    double noise = -1;  // standard error of its fog light, relative to the mean; negative: not known yet
};

// Errors of an image, relative to the reference's mean.
struct ErrorFigures {
    double worst = 0, picture = 0, fog = 0; // RMS errors; worst: the larger of the two, `rmse_rel` of tyndall compare
    double bias = 0;                        // of the image: above 0 it is too bright
    double noise = -1;                      // the part of `worst` that is noise, as RMS; negative: not known yet
};

// Pixel values for inspection: linear Rec.709, and depth along the view in meters.
struct PixelValues {
    Image<vec3> color;
    Image<float> depth;
};

// "250, 200  R 0.12 G 0.11 B 0.08  -0.9 stops  4.52 m" for a pixel of the whole image, which may be larger than
// `values`; stops are relative to middle gray.
std::string pixel_text(const PixelValues& values, ivec2 whole, ivec2 pixel);

struct ShownPicture {
    uint64_t revision = 0;
    int frame = 1;
    Image<glm::u8vec4> codes;       // may be smaller than wanted; empty: keep the previous image
    int across = 1;                 // images side by side in `codes`
    ivec2 wanted{0};                // full size of the image
    std::string mode;               // that rendered it, perhaps the stand-in
    std::string beside;             // that rendered its right part; empty = one mode throughout
    double exposure = 0;            // stops, of image and fog
    int metering_id = 0;            // the request's,
    std::optional<double> measured; // and the exposure, if measured for it
    bool quick = false;             // made while things moved
    bool finished = false;          // will not be refined further
    int samples = 0;                // per pixel so far; the smaller number of two modes
    StageTimes times;               // of its last round of samples
    uint64_t non_finite = 0;
    std::shared_ptr<const PixelValues> values, values_beside; // of the mode, and of the right part
    std::optional<ReferenceFacts> reference;
    std::optional<ErrorFigures> errors, errors_beside; // of both modes, if errors are shown
    std::shared_ptr<const RayAnswer> ray;              // as far as known
    std::shared_ptr<const VolumePicture> volume;
    std::vector<LimitationGroup> limitations; // of the requested mode, worst first; empty in quick images
    std::vector<std::string> notes;
    std::string error; // why there is no image
    ExitCode code = ExitCode::ok;
};
}
