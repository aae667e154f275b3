// The techniques: what each computes, its limitations in a scene, and how it finds the light along camera rays.
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

// The light transport that a technique's images converge to; artistic ones solve none.
enum class Accuracy { artistic, homogeneous, single_scattering, multiple_scattering };
std::string_view name_of(Accuracy accuracy);

// Who shades the surfaces and background behind the fog. shared: the renderer. own: the mode, which receives whole
// camera rays, follows them through BLEND surfaces and adds surfaces and background itself. post: the renderer; the
// mode then works on the finished image.
enum class Surfaces { shared, own, post };

// The finished image that a mode with Surfaces::post works on, and what the mode adds to it. All images cover the full
// frame.
struct PostInput {
    const Image<vec3>& color; // linear Rec.709
    const Image<float>& alpha;
    const Image<float>& depth; // planar z, infinite where there is no surface
};
struct PostOutput {
    Image<vec3> radiance;
    Image<float> validity;
    std::vector<Image<vec3>> per_light; // if View::fog_parts: parts of radiance, one per light
};
using PostFunction = std::function<PostOutput(const PostInput&)>;

// One step of a mode's quality ladder: assignments "row=value row=value", and a name (empty: shown as its assignments).
struct Rung {
    std::string name, assignments;
};

// A technique: its row of the table.
struct Mode {
    std::string_view name, summary; // summary: how it works
    std::string_view use;           // what it is best used for
    Accuracy accuracy;
    Surfaces surfaces;
    Limitations (*limitations)(const View&, const Snapshot&, const Settings&);
    // Returns the fog along camera rays. History may be null. For Surfaces::post: the fog that the renderer applies to
    // the image before the post-process.
    ScatterFunction (*prepare)(const View&, const Snapshot&, const Settings&, History*);
    PostFunction (*prepare_post)(const View&, const Snapshot&, const Settings&) = nullptr; // for Surfaces::post only
    void (*append_rows)(std::vector<SettingRow>& rows) = nullptr;                          // for its own settings
    void (*set_quality)(Settings& settings, Quality quality) = nullptr; // presets of its own settings; null = none
    std::vector<Rung> (*rungs)() = nullptr;                             // from fastest to most accurate
    std::string_view also_reads{};                                      // prefix of another mode's rows that it reads
    std::string_view color{};                                           // in charts
    bool uses_history = false;                                          // whether it uses a History
    bool adds_fluence = false;        // whether it can add multiple scattering (fluence.orders)
    bool interactive = false;         // whether it is fast enough for interactive camera moves
    bool samples_soft_lights = false; // whether it samples soft lights: noise instead of bias
    bool often_fastest = false;       // whether it often reaches an error sooner than the main mode
    bool traces_channels = false;     // whether it can trace all channels of chromatic fog together

    // What the stability suite (measure/stress) requires of a technique that is not artistic.
    bool resolves_density = true; // renders grids at their full detail
    bool casts_shadows = true;
    bool resolves_lamps = true; // resolves the glow around a lamp per pixel
    bool adapts_steps = true;   // takes shorter steps in denser fog
};

// The one table (modes/table.cpp).
std::span<const Mode> modes();

// The first row: the default mode, and the single-scattering reference at Quality::reference.
inline const Mode& main_mode() { return modes().front(); }

// The first row with Accuracy::multiple_scattering, and the first interactive one.
const Mode& mode_of_all_orders();
const Mode& interactive_mode();

const Mode& find_mode(std::string_view name, std::string_view where = {}); // throws Error (usage) listing the names

// Whether the mode applies style.*; modes with Surfaces::own ignore it.
bool honors_style(const Mode& mode);

// Prefix of a mode's own rows: radial_blur in radial_blur.samples.
std::string row_prefix(const Mode& mode);

// Whether a row can change the mode's images.
bool reads(const Mode& mode, std::string_view row);

// Whether the mode is unbiased: its only error is noise, which the variance of an image measures.
bool is_unbiased(const Mode& mode);
}
