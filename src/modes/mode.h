// The techniques: what each promises, where it fails, and how it turns a scene into light along camera rays.
#pragma once
#include "base/image.h"
#include "integrate/ray_batch.h"
#include "modes/promise.h"

#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
struct History;
struct Settings;
struct Snapshot;
struct View;

// A picture without fog, and what a mode with Surfaces::post adds to it. All images cover the full picture.
struct PlainPicture {
    const Image<vec3>& color; // linear Rec.709
    const Image<float>& alpha;
    const Image<float>& depth; // planar z, infinite where there is no surface
};
struct Addition {
    Image<vec3> radiance;
    Image<float> validity;
    std::vector<Image<vec3>> per_light; // if the view wants them: parts of radiance, one for each light
};
using PostFunction = std::function<Addition(const PlainPicture&)>;

struct Mode {
    std::string_view name, summary;
    Accuracy accuracy;
    Surfaces surfaces;
    std::vector<Limit> (*limits)(const View&, const Snapshot&, const Settings&);
    // History may be null. Of Surfaces::post: the fog of the picture it works on.
    ScatterFunction (*prepare)(const View&, const Snapshot&, const Settings&, History*);
    PostFunction (*prepare_post)(const View&, const Snapshot&, const Settings&) = nullptr; // for Surfaces::post only
    bool remembers = false; // whether a History changes anything
};

std::span<const Mode> modes();
const Mode& find_mode(std::string_view name); // throws Error (usage) listing the names

// Whether style.* changes its pictures: the truth has none.
bool honours_style(const Mode& mode);

// Whether it can add light that scatters more than once (fluence.orders).
bool has_fluence(const Mode& mode);

// Whether the mode's only error is noise, so that the variance of a picture says how far it is from the truth.
bool error_is_noise(const Mode& mode);
}
