// The techniques: what each promises, where it fails, and how it turns a scene into light along camera rays.
#pragma once
#include "base/image.h"
#include "integrate/ray_batch.h"
#include "modes/limitation.h"

#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
struct History;
struct SettingRow;
struct Settings;
struct Snapshot;
struct View;
enum class Quality;

// What a technique promises of its images.
enum class Accuracy { artistic, homogeneous, single_scattering, multiple_scattering };
std::string_view name_of(Accuracy accuracy);

// Who shades what lies behind the fog: the renderer; the mode, which then gets whole camera rays, follows them through
// BLEND surfaces and adds surfaces and background itself; or nobody, because the mode works on the finished picture.
enum class Surfaces { shared, own, post };

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

// A rung of a mode's ladder: "row=value row=value"; its name, or what it sets.
struct Rung {
    std::string name, assignments;
};

// A technique: all that is true of it alone.
struct Mode {
    std::string_view name, summary; // summary: how it works
    std::string_view use;           // what to take it for
    Accuracy accuracy;
    Surfaces surfaces;
    Limitations (*limitations)(const View&, const Snapshot&, const Settings&);
    // History may be null. Of Surfaces::post: the fog of the picture it works on.
    ScatterFunction (*prepare)(const View&, const Snapshot&, const Settings&, History*);
    PostFunction (*prepare_post)(const View&, const Snapshot&, const Settings&) = nullptr; // for Surfaces::post only
    void (*append_rows)(std::vector<SettingRow>& rows) = nullptr;                          // of its own settings
    void (*set_quality)(Settings& settings, Quality quality) = nullptr; // its own; null = always the same
    std::vector<Rung> (*rungs)() = nullptr;                             // from the quickest to the most careful
    std::string_view also_reads{};                                      // prefix of rows that are another's
    std::string_view color{};                                           // in charts
    bool remembers = false;                                             // whether a History changes anything
    bool adds_fluence = false;        // whether it can add light that scatters more than once (fluence.orders)
    bool interactive = false;         // whether it keeps up with a hand on the camera
    bool samples_soft_lights = false; // whether soft lights add noise, and not bias

    // What the stability suite holds a technique to that is not artistic.
    bool resolves_density = true; // of grids, in every detail
    bool casts_shadows = true;
    bool resolves_lamps = true; // what is next to a lamp, pixel by pixel
    bool adapts_steps = true;   // to how thick fog is
};

// The one table (modes/table.cpp).
std::span<const Mode> modes();

// The first row: the default, and at Quality::reference the truth of light that scatters once.
inline const Mode& main_mode() { return modes().front(); }

// The first row with the truth of all scattered light, and the first that is interactive.
const Mode& mode_of_all_orders();
const Mode& interactive_mode();

const Mode& find_mode(std::string_view name, std::string_view where = {}); // throws Error (usage) listing the names

// Whether style.* changes its pictures: the truth has none.
bool honours_style(const Mode& mode);

// What the names of a technique's own rows begin with: radial_blur of radial_blur.samples.
std::string row_prefix(const Mode& mode);

// Whether a row can change the mode's images.
bool reads(const Mode& mode, std::string_view row);

// Whether the mode's only error is noise, so that the variance of a picture says how far it is from the truth.
bool error_is_noise(const Mode& mode);
}
