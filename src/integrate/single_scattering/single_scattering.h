// Single scattering: per-frame data, and the integral along a packet of rays over the intervals that each light
// reaches. Used by the march and shadow-volume techniques.
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
// How a light's shadows along rays are computed: exactly, from its center (volumes) or from a sample point per ray
// (slices); or at points on the ray, by shadow rays or a shadow map.
enum class ShadowMethod { none, volumes, slices, rays, maps };

// The fastest exact method; rays if surfaces have alpha or too many triangles. `room`: there is memory for the volumes
// of all lights (has_room_for_volumes()).
ShadowMethod exact_shadows(const View& view, const Light& light, const Occluders& occluders, bool room);
bool has_room_for_volumes(const View& view, const Snapshot& snapshot);

struct LightShadows {
    ShadowMethod by = ShadowMethod::none;
    std::shared_ptr<const ShadowView> view; // the volumes as seen from the camera
    std::shared_ptr<const ShadowVolumes> volumes;
    std::shared_ptr<const ShadowMap> map; // for `maps`
    const ShadowSlices* slices = nullptr; // for `slices`; owned by the snapshot
};

// Draws the sides of shadow volumes as bright sheets instead of integrating the light between them.
struct Shells {
    float length;    // meters behind the occluder at which a shell has faded out
    float intensity; // share of that length: a shell is as bright as this depth of lit fog
};

// Quadrature nodes per ray for a light with a gobo.
inline constexpr double gobo_nodes = 64;

// Sampling resolution along rays for a light's IES profile and gobo.
struct FilterSteps {
    double angle = 0;     // maximum angle, seen from the light, per quadrature rule; 0 = no filter
    double parts = 1;     // maximum number of parts per ray
    bool sampled = false; // one jittered node per part, for gobos too fine for quadrature
};
FilterSteps filter_steps(const Light& light);

struct SingleScattering {
    Snapshot snapshot; // media and lights after applying the settings
    StyleSettings style;
    Camera camera;
    float margin = 0;               // pixels by which a ray may leave its pixel
    bool sampled = false;           // fog is sampled in steps; otherwise integrated analytically
    int nodes = 4;                  // Gauss–Legendre nodes per lit interval of analytic fog
    int steps = 24;                 // equal steps per ray of sampled fog ...
    std::optional<MarchSteps> rule; // ... or steps by this rule
    float opaque = 16;              // optical depth beyond which sampled fog is skipped
    int light_points = 1;           // shadow sample points per soft light
    LobeCuts lobe;                  // cuts for narrow lobes under local lights
    std::optional<Shells> shells;
    std::vector<Box> heterogeneous; // bounds of grids approximated as homogeneous
    std::vector<Medium> fields;     // emission-only media, for the exact march; others add them separately
    std::vector<LightDepth> depths;
    std::vector<ConeFalloff> cones;
    std::vector<FilterSteps> filter_steps;      // one per light
    std::vector<LightShadows> shadows;          // one per light
    std::shared_ptr<const FluenceGrid> fluence; // null = no multiple scattering
};

// True if any medium is a grid.
bool has_grid(const Snapshot& snapshot);

// Fills the per-light data and the camera of the frame; `by` selects the shadow method of lights that cast shadows.
void add_lights(const View& view, LightTransmittance method, int light_resolution,
                const std::function<ShadowMethod(const Light&)>& by, SingleScattering& frame);

// Cuts along rays, between which the fog is smooth or is one step.
struct RaySegments {
    std::vector<float> at; // [cut·16 + ray], ascending; the last is repeated if other rays have more
    int pieces[16];        // pieces between the cuts of each ray; 0 without fog
    int max_pieces = 0;    // maximum over the rays

    float low(size_t ray) const { return at[ray]; }
    float high(size_t ray) const { return at[16 * static_cast<size_t>(pieces[ray]) + ray]; }
};
void find_segments(const SingleScattering& frame, std::span<const Ray> rays, RaySegments& cuts);

// Single scattering along up to 16 rays.
void single_scattering_packet(const SingleScattering& frame, const RayBatch& batch, std::span<Scatter> results);

// Finds the crossings of rays with a light's shadow volumes up to the ends of `reached`; `dark` = the volume counts at
// the ray origins. Rays with an empty interval are skipped.
void find_shadows(const SingleScattering& frame, size_t light, const RayBatch& batch,
                  const Interval<double> (&reached)[16], std::vector<ShadowCrossing>& crossings, int (&dark)[16]);
}
