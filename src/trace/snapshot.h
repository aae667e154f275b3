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

struct BackgroundState {
    bool stated = false; // the scene defines a background, even a black one
    BackgroundKind kind = BackgroundKind::color;
    vec3 color{0}, zenith{0}, ground{0};
    std::shared_ptr<const Image<vec3>> image;
    bool lat_long = false;
    float intensity = 1, rotation = 0;
};

// A medium's bricks as made from its file or recipe, a key of what they were made from, and the bricks with the
// medium's transform applied.
struct FogSource {
    std::string key;         // empty = nothing to reuse
    dmat4 index_to_world{1}; // before the medium's transform
    std::shared_ptr<const BrickPool> bricks, placed;
    float unit = 1;                           // density that a 1 in them stands for
    mat4 matrix{1};                           // the medium's transform
    std::shared_ptr<const MediumGrids> grids; // its grids besides density
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
    std::vector<Light> lights; // with non-zero intensity; area lights come last
    std::vector<Medium> media; // those that attenuate or emit; extinction is non-zero
    vec3 ambient{0};
    BackgroundState background;
    std::shared_ptr<const Environment> environment; // null = none
    std::shared_ptr<const Occluders> occluders;     // of all surfaces
    std::vector<CasterSet> casters;                 // of lights that only some surfaces shadow
    std::vector<std::vector<bool>> lit;             // flags per instance, for lights that illuminate only some
    std::vector<ivec2> emission_links; // per instance, sets of its light's casters and of what that lights; empty = all
    vec3 anchor{0};                    // center of the scene, the same in every frame
    float extent = 10;                 // meters: size of the scene, the same in every frame
    Box bounds;                        // of meshes, local lights and bounded media
    std::vector<std::string> notes;    // what was repaired in this frame's files; to be reported once
    std::vector<FogSource> fog_sources;                   // one per medium of the scene: what the next frame can reuse
    std::shared_ptr<FrameCache> cache;                    // entries of this frame; null in snapshots made by hand
    std::shared_ptr<FrameCache> previous_cache;           // entries of the previous frame; null for the first
    std::shared_ptr<CacheFolder> files;                   // of a prepared plan; else null
    std::shared_ptr<const std::vector<Snapshot>> moments; // of a frame with motion blur; this is their middle

    // Out of line, so that code that only holds a snapshot needs neither lights nor media.
    Snapshot();
    Snapshot(const Snapshot&);
    Snapshot(Snapshot&&) noexcept;
    Snapshot& operator=(const Snapshot&);
    Snapshot& operator=(Snapshot&&) noexcept;
    ~Snapshot();
};

// Evaluates all animation, loads or generates the frame's fog, builds the ray tracing scene. Shares what did not change
// with `previous` (of the same, unmodified Scene); the result is the same without it. Reads what it can from `files`.
// The Scene must outlive the snapshot. Throws Error.
Snapshot make_snapshot(const Scene& scene, Moment moment, const Snapshot* previous = nullptr,
                       MissingFrame missing = MissingFrame::error, std::shared_ptr<CacheFolder> files = nullptr);

// Sets anchor and extent from the surfaces, bounded fog and camera at the first frame; in empty scenes from lamps, else
// from what the camera looks at, else from the fog's mean free path. Lengths that must not depend on the unit of length
// are fractions of the extent, and lattices fixed in the world are aligned to the anchor. Snapshots take both from the
// previous one: needed again when the scene was edited.
void set_extent(const Scene& scene, Snapshot& snapshot);

// All moments of a frame, each sharing data with the previous one. Fog is rebuilt when it has moved by half a voxel,
// less often if that would take more than about 1 GiB; the moments in between share it.
Snapshot make_snapshot(const Scene& scene, const FrameMoments& moments, const Snapshot* previous = nullptr,
                       MissingFrame missing = MissingFrame::error, std::shared_ptr<CacheFolder> files = nullptr);

// Whether extinction differs between channels, and the snapshot as one channel, 0 to 2, sees it.
bool is_chromatic(const Snapshot& snapshot);
Snapshot channel_of(const Snapshot& snapshot, int channel);

// The surfaces that shadow the light; null = none.
const std::shared_ptr<const Occluders>& shadow_casters(const Light& light, const Snapshot& snapshot);
const std::shared_ptr<const Occluders>& shadow_casters(const Environment& environment, const Snapshot& snapshot);

// Whether an instance of the scene shadows the light, and whether the light shines on it.
bool shadows_light(const Light& light, const Snapshot& snapshot, int instance);
bool is_lit(const Light& light, const Snapshot& snapshot, int instance);
bool is_lit(const Environment& environment, const Snapshot& snapshot, int instance);

// The surfaces in a set of casters, -1 = all; null if there are none.
const std::shared_ptr<const Occluders>& caster_surfaces(int set, const Snapshot& snapshot);

// The sets that shadow the light an instance emits (x) and that it lights (y), -1 = all; whether it lights another one.
ivec2 emission_links(const Snapshot& snapshot, int instance);
bool is_lit_by_emitter(const Snapshot& snapshot, int emitter, int instance);

// Whether a surface that shadows one of the lights has alpha.
bool has_alpha_shadows(const Snapshot& snapshot);

BackgroundState background_at(const Background& background, const Moment& moment);

// Position of a direction in a latitude-longitude map, 0..1 from the upper left. The map's center is -Z; `rotation`
// (radians) turns it to the left.
vec2 lat_long_position(vec3 direction, float rotation);

// Whether there is a background: one that the scene defines, or one that is not black.
bool has_background(const BackgroundState& background);

// Background radiance. `screen`: position in the image, 0..1 from the upper left (for plates).
vec3 background_radiance(const BackgroundState& background, vec3 direction, vec2 screen);
}
