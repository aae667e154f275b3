// Light scattered once in fog: what is made once per frame, and the integral along a packet of rays over the stretches
// that each light reaches. Behind march and shadow-volume.
#pragma once
#include "base/gauss_legendre.h"
#include "integrate/lights/light_along.h"
#include "integrate/lobe_cuts.h"
#include "integrate/march_steps.h"
#include "integrate/ray_batch.h"
#include "integrate/style.h"
#include "trace/fluence/fluence.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"

#include <optional>

namespace tyndall {
// How a light's shadows are found along rays: exactly, of its centre or of a point that each ray picks; or asked for at
// points of the ray, by shadow rays or in a shadow map.
enum class ShadowsBy { none, volumes, slices, rays, maps };

// The quickest that is exact; rays where surfaces have alpha or are too many. `room`: for the volumes of all lights
// that would have some.
ShadowsBy exact_shadows(const View& view, const Light& light, const Occluders& occluders, bool room);
bool has_room_for_volumes(const View& view, const Snapshot& snapshot);

struct LightShadows {
    ShadowsBy by = ShadowsBy::none;
    std::shared_ptr<const ShadowView> view; // with `volumes`, and as the camera sees them
    std::shared_ptr<const ShadowVolumes> volumes;
    std::shared_ptr<const ShadowMap> map; // with `maps`
    const ShadowSlices* slices = nullptr; // with `slices`; the snapshot's
};

// The sides of the volumes as bright sheets instead of the light between them.
struct Shells {
    float length;    // metres behind the occluder at which a shell has faded out
    float intensity; // share of that length: the depth of lit fog a shell is as bright as
};

// Nodes of a ray on all that it sees of a light with a gobo.
inline constexpr double gobo_nodes = 64;

// How finely rays follow a light's IES profile and gobo.
struct FilterSteps {
    double angle = 0;     // seen from the light, that one set of nodes may span; 0 = no filter
    double parts = 1;     // that what a ray sees of the light has at most
    bool sampled = false; // by one jittered node each: of a gobo too fine for any quadrature
};
FilterSteps filter_steps(const Light& light);

struct SingleScattering {
    Snapshot snapshot; // media and lights as the settings see them
    StyleSettings style;
    Camera camera;
    float margin = 0;               // pixels a ray may stray from its pixel
    bool sampled = false;           // fog is; otherwise it is integrated in closed form
    int nodes = 4;                  // Gauss–Legendre nodes on each lit stretch of fog in closed form
    int steps = 24;                 // along a ray of sampled fog, of equal length ...
    std::optional<MarchSteps> rule; // ... or as this asks for
    float opaque = 16;              // optical depth behind which sampled fog is not asked for
    int light_points = 1;           // of a soft light, asked for shadows at once
    LobeCuts lobe;                  // of the fog in the light of lamps
    std::optional<Shells> shells;
    std::vector<Box> heterogeneous; // fog that is not what it is taken for
    std::vector<Medium> fields;     // media that only emit, for the exact march; others add them by themselves
    std::vector<LightDepth> depths;
    std::vector<ConeFalloff> cones;
    std::vector<FilterSteps> filter_steps;      // one per light
    std::vector<LightShadows> shadows;          // one per light
    std::shared_ptr<const FluenceGrid> fluence; // null = light scatters once only
};

// Whether a medium is a grid.
bool has_grid(const Snapshot& snapshot);

// Fills depths, cones and shadows of the frame's lights, and what it knows of the camera; `by` picks the shadows of
// lights that cast some.
void add_lights(const View& view, LightTransmittance method, int light_resolution,
                const std::function<ShadowsBy(const Light&)>& by, SingleScattering& frame);

// Where rays are cut: between cuts the fog is smooth, or a step long.
struct RaySegments {
    std::vector<float> at; // [cut·16 + ray], ascending; the last repeated where other rays have more
    int pieces[16];        // between the cuts of each ray; 0 without fog
    int most = 0;          // of any ray

    float low(size_t ray) const { return at[ray]; }
    float high(size_t ray) const { return at[16 * static_cast<size_t>(pieces[ray]) + ray]; }
};
void find_segments(const SingleScattering& frame, std::span<const Ray> rays, RaySegments& cuts);

// Fog along up to 16 rays.
void single_scattering_packet(const SingleScattering& frame, const RayBatch& batch, std::span<Scatter> results);

// What rays cross of the volumes of a light, up to the ends of `reached`; `dark` = the counts before. Rays whose
// stretch is empty are left out.
void find_shadows(const SingleScattering& frame, size_t light, const RayBatch& batch,
                  const Interval<double> (&reached)[16], std::vector<ShadowCrossing>& crossings, int (&dark)[16]);
}
