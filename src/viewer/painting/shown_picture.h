// What the render thread made of a request, ready to be shown.
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
    double load = 0;    // scene at its moment: animation, fog, ray tracing structures
    double prepare = 0; // what the mode makes before its first ray
    double fog = 0;     // the mode's share of prepare and render
    double render = 0;
    double tone = 0;
    double total() const { return load + prepare + render + tone; }
};

// Of the reference that a picture is held against.
struct ReferenceFacts {
    std::string what; // "exact march, light scattered once"
    int samples = 0;  // per pixel so far
    bool finished = false;
    double change = -1; // by the step from quality final to the exact march; negative: not made yet
    double noise = -1;  // standard error of its fog light, a share of the mean; negative: not known yet
};

// How far a picture is from its reference, as shares of the reference's mean.
struct ErrorFigures {
    double worst = 0, picture = 0, fog = 0; // root mean squares; worst of both, `rmse_rel` of tyndall compare
    double bias = 0;                        // of the picture: above 0 it is too bright
    double noise = -1;                      // of worst, as a root mean square; negative: not known yet
};

// What its pixels are, to be read off: linear Rec.709, and metres along the view.
struct PixelValues {
    Image<vec3> color;
    Image<float> depth;
};

// "250, 200  R 0.12 G 0.11 B 0.08  -0.9 stops  4.52 m" of a pixel of the whole picture, which may be larger; stops
// count from middle grey.
std::string pixel_text(const PixelValues& values, ivec2 whole, ivec2 pixel);

struct ShownPicture {
    uint64_t revision = 0;
    int frame = 1;
    Image<glm::u8vec4> codes;       // may be smaller than wanted; empty: the picture before stays
    int across = 1;                 // pictures side by side in them
    ivec2 wanted{0};                // size of the whole picture
    std::string mode;               // that made it, perhaps a stand-in
    std::string beside;             // that made its right part; empty = it is all of one mode
    double exposure = 0;            // stops, of picture and fog
    int measures = 0;               // the request's,
    std::optional<double> measured; // and the exposure, where it was measured for it
    bool quick = false;             // made while things moved
    bool finished = false;          // will not get better
    int samples = 0;                // per pixel so far; of two modes, the fewer
    StageTimes times;               // of its last round of samples
    uint64_t non_finite = 0;
    std::shared_ptr<const PixelValues> values, values_beside; // of the mode, and of what is beside it
    std::optional<ReferenceFacts> reference;
    std::optional<ErrorFigures> errors, errors_beside; // of both techniques, where the errors are shown
    std::shared_ptr<const RayAnswer> ray;              // as far as it is known
    std::shared_ptr<const VolumePicture> volume;
    std::vector<LimitationGroup> limitations; // of the mode asked for, worst first; empty in quick pictures
    std::vector<std::string> notes;
    std::string error; // why there is no picture
    ExitCode code = ExitCode::ok;
};
}
