// How to render: plain structs with defaults, and the same fields as named rows for --set, help, the viewer and
// headers.
#pragma once
#include "base/math.h"
#include "integrate/march_settings.h"
#include "integrate/style.h"
#include "trace/fluence/settings.h"
#include "trace/sampling/jitter.h"
#include "trace/sampling/pixel_filter.h"
#include "trace/transmittance/light_transmittance.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// How large a picture a technique computes inside, along each side; its pixels are then spread over the whole one.
enum class PictureShare { full, half, third, quarter };

struct PixelSettings {
    int samples = 4; // camera rays per pixel
    PixelFilter filter = PixelFilter::blackman_harris;
    float filter_radius = 1; // pixels
    Jitter jitter = Jitter::interleaved;
    int lamp_samples = 16; // most times as many rays where a local light is seen
    int edge_samples = 4;  // most times as many rays where the picture changes from pixel to pixel
};

enum class BlurSource { occlusion, highlights };

struct RadialBlurSettings {
    BlurSource source = BlurSource::occlusion;
    int samples = 64;       // along the line to the light
    float density = 0.95f;  // share of that line they cover
    float decay = 0.97f;    // from one of 32 samples to the next
    float weight = 1;       // of every sample
    float exposure = 1;     // of their sum
    float threshold = 1;    // highlights: luminance that counts as bright
    float size = 2.5f;      // occlusion: radius of the bright sky around a sun, in picture heights
    float lamp_size = 0.3f; // occlusion: radius of the bright disc of other lights, metres
    float fade = 2;         // how far outside the picture a light may be before its rays have faded, in half pictures
    PictureShare picture = PictureShare::half;
    bool fog = true; // what lies behind fades in even fog
};

enum class FroxelVisibility { off, rays, slices };
enum class FroxelLookup { trilinear, tricubic, jittered };

// Terms of the light (phase, heterogeneity, emission, ambient, light-side transmittance) are those of the march.
struct FroxelSettings {
    int tile = 8; // pixels
    int depth_slices = 64;
    float depth_growth = 4; // thickness of the last slice over that of the first
    FroxelVisibility visibility = FroxelVisibility::slices;
    int shadow_rays = 1; // per froxel and frame
    FroxelLookup lookup = FroxelLookup::trilinear;
    float history = 0.9f; // weight of the frames before
    bool amortise = false;
};

enum class ConeAttenuation { inverse_square, linear, none };
enum class ConeEdge { physical, soft };

struct ConeSettings {
    int nodes = 8;         // Gauss–Legendre nodes on the widest pieces of a ray
    float near_radius = 0; // of the lens of a spot: its light begins where the cone is that wide, metres
    ConeAttenuation attenuation = ConeAttenuation::inverse_square;
    ConeEdge edge = ConeEdge::physical;
    float inner = 0.5f;       // with ConeEdge::soft: share of the outer cone's angle that is evenly lit
    float noise = 0;          // modulates the light, 0..1
    float noise_size = 0.6f;  // metres
    float noise_speed = 0.2f; // metres per second, upwards
    PictureShare picture = PictureShare::full;
};

enum class CardFacing { axis, camera, cross };

struct BillboardSettings {
    int cards = 64; // most per light, largest openings first
    int rays = 128; // across the light's view that looks for openings
    CardFacing facing = CardFacing::axis;
    float brightness = 1;    // factor on all cards and veils
    float veil = 0.5f;       // share of the open air's fog that is taken for lit
    float gaps = 4;          // factor on cards in the open, which have to show before the veil
    float streaks = 0.55f;   // how far stripes along the beam darken it, 0..1
    float stripes = 14;      // stripes across a card
    float soft = 1;          // share of a card's half width that fades out
    float scroll = 0.05f;    // of the texture along the beam, metres per second
    float sway = 0.15f;      // how far the brightness swings, 0..1
    float specks = 0.25f;    // brightness of dust particles in the beam
    float near_fade = 0.6f;  // metres from the eye within which a card fades in
    float far_fade = 1e6f;   // metres from the eye at which it has faded out
    float soft_depth = 0.4f; // metres before a surface over which a card fades out
    bool fog = true;         // even fog dims cards and what is behind
};

inline constexpr int all_orders = 65536; // ends paths that nothing else ends

struct PathSettings {
    int orders = all_orders; // most scatterings of light, in fog or on surfaces
    bool emission = true;
    bool ambient = true;
};

// What shadow volumes are drawn as: the light between them, or their sides themselves as bright sheets.
enum class ShadowDraw { exact, shells };
// The fog that is integrated: every medium at its mean density in closed form, or the true densities in short steps.
// `automatic` samples where there is a grid.
enum class ShadowFog { automatic, even, sampled };

struct ShadowVolumeSettings {
    ShadowDraw draw = ShadowDraw::exact;
    ShadowFog fog = ShadowFog::automatic;
    int nodes = 4;                 // Gauss–Legendre nodes on each lit stretch of even fog
    int steps = 24;                // along a ray, where fog is sampled
    int light_resolution = 64;     // cells across the fog in the light grids, where fog is sampled
    float shell_length = 0;        // metres behind the occluder at which a shell has faded out; 0 = half the scene
    float shell_intensity = 0.03f; // share of that length: the depth of lit fog a shell is as bright as
};

enum class Spacing { angle, distance };

struct ShadowMapSettings {
    int steps = 24;  // per ray, and per local light on what it reaches
    int lookups = 4; // in the maps, per step
    Spacing spacing = Spacing::angle;
    int resolution = 512; // texels across each map
    int cascades = 3;     // most maps of a sun
    int pcf = 0;          // 0 nearest texel, 1 the four around, 2 sixteen
    float bias = 0;       // texels
    LightTransmittance light = LightTransmittance::grid;
    PictureShare picture = PictureShare::full;
    bool blur = false; // of the jitter's pattern
};

struct Settings {
    PixelSettings pixel;
    StyleSettings style;
    MarchSettings march;
    FluenceSettings fluence; // of march and froxel
    ConeSettings cone;
    BillboardSettings billboard;
    PathSettings path;
    RadialBlurSettings radial_blur;
    ShadowVolumeSettings shadow_volume;
    FroxelSettings froxel;
    ShadowMapSettings shadow_map;
};

enum class Quality { draft, preview, final, reference };
Settings settings_for(Quality quality);

// One field by name: march.step_depth, its unit, range or choices, and what it does.
struct SettingRow {
    std::string name, unit, doc;
    std::vector<std::string> choices; // of an enumeration or switch; empty for a number
    double low = 0, high = 0;         // range of a number
    bool integer = false;
    std::function<std::string(const Settings&)> get;
    std::function<void(Settings&, std::string_view)> set; // throws Error (usage)
    int parts = 1;                                        // numbers of a value; 3 = a colour
};
const std::vector<SettingRow>& setting_rows();

// "march.step_depth=0.1". Throws Error (usage): an unknown row names the nearest one.
void apply_setting(Settings& settings, std::string_view assignment);

std::string_view name_of(Quality quality);
Quality quality_named(std::string_view name); // throws Error (usage)
}
