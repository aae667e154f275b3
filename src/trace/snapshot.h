// A scene at one moment, ready to trace.
#pragma once
#include "base/io/file_sequence.h"
#include "base/math.h"
#include "scene/background_kind.h"
#include "trace/moment.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace tyndall {
struct BrickPool;
struct Background;
struct CacheFolder;
struct Environment;
struct FrameCache;
struct Light;
struct Medium;
struct MediumGrids;
class Occluders;
struct Scene;
template<class T> struct Image;

struct BackgroundNow {
    bool stated = false; // the scene says what is there, be it black
    BackgroundKind kind = BackgroundKind::color;
    vec3 color{0}, zenith{0}, ground{0};
    std::shared_ptr<const Image<vec3>> image;
    bool lat_long = false;
    float intensity = 1, rotation = 0;
};

// Bricks as file or recipe made them, what they were made from, and where the medium's own transform put them.
struct FogSource {
    std::string key;         // empty = nothing to reuse
    dmat4 index_to_world{1}; // before the medium's transform
    std::shared_ptr<const BrickPool> bricks, placed;
    mat4 matrix{1};                           // the medium's transform
    std::shared_ptr<const MediumGrids> grids; // what it has beside its density
};

// Some of the scene's instances, and their surfaces.
struct CasterSet {
    std::vector<bool> instances;
    std::shared_ptr<const Occluders> occluders;
};

struct Snapshot {
    const Scene* scene = nullptr;
    double seconds = 0;
    int frame = 0;
    std::vector<Light> lights; // of non-zero intensity; those with a face after all others
    std::vector<Medium> media; // that dim light or emit it; of non-zero extinction, the same in all channels
    // Where channels differ, which `media` is the mean of: the media as red, green and blue light meet them. Else
    // empty.
    std::array<std::vector<Medium>, 3> channel_media;
    vec3 ambient{0};
    BackgroundNow background;
    std::shared_ptr<const Environment> environment; // light from all around; null = none
    std::shared_ptr<const Occluders> occluders;     // of all surfaces
    std::vector<CasterSet> casters;                 // of lights that some surfaces alone shadow
    std::vector<std::vector<bool>> lit;             // instances, of lights that shine on some alone
    vec3 anchor{0};                                 // the middle of the scene, the same in every frame
    float extent = 10;                              // metres: how large it is, the same in every frame
    Box bounds;                                     // of meshes, local lights and bounded media
    std::vector<std::string> notes;                 // what was mended in the files of this frame; say once
    std::vector<FogSource> fog_sources;             // one per medium of the scene: what the next frame can use again
    std::shared_ptr<FrameCache> cache;              // made for this frame so far; null in snapshots made by hand
    std::shared_ptr<FrameCache> cache_before;       // for the frame before; null of the first
    std::shared_ptr<CacheFolder> files;             // with things of a plan that was prepared; else null
    std::shared_ptr<const std::vector<Snapshot>> moments; // of a frame with an open shutter, whose middle this is

    // Not inline: who only holds a snapshot needs neither lights nor media.
    Snapshot();
    Snapshot(const Snapshot&);
    Snapshot(Snapshot&&) noexcept;
    Snapshot& operator=(const Snapshot&);
    Snapshot& operator=(Snapshot&&) noexcept;
    ~Snapshot();
};

// Evaluates every animation, loads or grows the frame's fog, builds the ray tracing scene. What did not change since
// `previous` (of the same, unchanged Scene) is shared with it, and the result is the same without. The Scene must
// outlive it. What `files` holds is taken from there. Throws Error.
Snapshot make_snapshot(const Scene& scene, Moment moment, const Snapshot* previous = nullptr,
                       MissingFrame missing = MissingFrame::error, std::shared_ptr<CacheFolder> files = nullptr);

// All moments of a frame, each sharing with the one before it. Neighbouring moments share the fog of recipes, which is
// grown anew where it has moved half a voxel, and less often where that would take more than some 1 GiB.
Snapshot make_snapshot(const Scene& scene, const FrameMoments& moments, const Snapshot* previous = nullptr,
                       MissingFrame missing = MissingFrame::error, std::shared_ptr<CacheFolder> files = nullptr);

// Whether fog dims the channels differently, and the scene as one of them, 0 to 2, meets it.
bool is_chromatic(const Snapshot& snapshot);
Snapshot channel_of(const Snapshot& snapshot, int channel);

// The surfaces that shadow the light; null = none does.
const std::shared_ptr<const Occluders>& shadow_casters(const Light& light, const Snapshot& snapshot);
const std::shared_ptr<const Occluders>& shadow_casters(const Environment& environment, const Snapshot& snapshot);

// Whether an instance of the scene shadows the light, and whether the light shines on it.
bool shadows_light(const Light& light, const Snapshot& snapshot, int instance);
bool is_lit(const Light& light, const Snapshot& snapshot, int instance);
bool is_lit(const Environment& environment, const Snapshot& snapshot, int instance);

// Whether light gets through a surface that shadows one of the lights.
bool has_alpha_shadows(const Snapshot& snapshot);

BackgroundNow background_at(const Background& background, double seconds);

// Where a direction lies on a map from the upper left, 0..1: its middle is -Z, and `rotation` (radians) turns it to the
// left.
vec2 lat_long_position(vec3 direction, float rotation);

// Whether there is one: where the scene says nothing of it, it is black and nothing.
bool has_background(const BackgroundNow& background);

// Radiance behind everything. `screen` is the position on the picture, 0..1 from the upper left (for plates).
vec3 background_radiance(const BackgroundNow& background, vec3 direction, vec2 screen);
}
