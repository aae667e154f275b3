// Limitations that several techniques share, and the functions that detect them.
#pragma once
#include "base/math.h"
#include "modes/limitation.h"
#include "trace/fluence/settings.h"
#include "trace/transmittance/light_transmittance.h"

namespace tyndall {
struct Medium;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind single_scattering_only{
    "single_scattering_only", "single scattering only: with up to {} optical depths of scattering, real fog is "
                              "brighter and softer (--orders all adds multiple scattering in march and froxel)"};
inline constexpr LimitationKind float_precision{
    "float_precision", "float precision at this distance from the origin is {} m: edges and shadows are no finer"};
inline constexpr LimitationKind unshadowed_ambient{"unshadowed_ambient",
                                                   "ambient light is not shadowed by surfaces or fog"};
inline constexpr LimitationKind light_grid_cells{
    "light_grid_cells", "cells of the light grid are up to {} optical depths deep: light in dense parts is blurred"};
inline constexpr LimitationKind long_steps{
    "long_steps",
    "steps of about {} m are longer than a voxel ({} m): fine detail is blurred or noisy; more steps resolve it"};
inline constexpr LimitationKind deep_steps{"deep_steps",
                                           "steps are up to {} optical depths deep (about {} m): how light fades "
                                           "within a step is not resolved; more steps resolve it"};
inline constexpr LimitationKind cached_fluence{"cached_fluence",
                                               "multiple scattering is cached in cells of {} m: it has no finer "
                                               "detail, and may leak around corners within a cell"};
inline constexpr LimitationKind table_by_mean_cosine{
    "table_by_mean_cosine", "multiple scattering knows the mean cosine of its phase function only: at right angles it "
                            "scatters {} times as much as the table says"};
inline constexpr LimitationKind fog_scatters_alone{
    "fog_scatters_alone", "multiple scattering is computed for the fog and its lights only: surfaces get direct light "
                          "alone, and ambient light and emission are not scattered further"};
inline constexpr LimitationKind unbounded_fluence{
    "unbounded_fluence", "in unbounded fog, multiple scattering is computed in and around the scene only"};
inline constexpr LimitationKind orders_left_out{"orders_left_out", "scattering orders above {n} are left out"};
inline constexpr LimitationKind drawn_as_homogeneous{"drawn_as_homogeneous",
                                                     "drawn as homogeneous fog of its mean density"};
inline constexpr LimitationKind mean_emission_color{
    "mean_emission_color", "its light is drawn in its mean color, which {}% of it differs from, and straight between "
                           "voxels whatever the temperature there"};
inline constexpr LimitationKind mean_albedo{"mean_albedo",
                                            "scatters in its mean color, which {}% of what it scatters differs from"};
inline constexpr LimitationKind shutter_moments{
    "shutter_moments", "things move up to {} pixels on the image between two of the {n} moments that motion blur is "
                       "made of (--time-samples)"};
inline constexpr LimitationKind shutter_fades{
    "shutter_fades", "its brightness changes so much between two of the moments that motion blur is made of that it is "
                     "off by up to {}% (--time-samples)"};
inline constexpr LimitationKind still_volumes{
    "still_volumes", "its files are one a frame: it stands still for the {} s that the shutter is open (a \"velocity\" "
                     "in its \"grids\" moves it, \"blend\" in its \"sequence\" mixes files)"};
inline constexpr LimitationKind blended_volumes{
    "blended_volumes",
    "while the shutter is open two of its files are mixed, with up to {}% of the lesser: what moves by "
    "more than a voxel from file to file is seen twice"};
inline constexpr LimitationKind advected_volumes{
    "advected_volumes", "moves along straight lines by its velocities, up to {} voxels from where its file has it, "
                        "through {n} places"};
inline constexpr LimitationKind visibility_off{"visibility_off", "visibility is off: no shafts"};
inline constexpr LimitationKind unattenuated_light{
    "unattenuated_light", "light-side transmittance is off: fog does not dim the light that crosses it"};
inline constexpr LimitationKind average_light{
    "average_light", "light-side transmittance is average: light is dimmed equally everywhere"};
inline constexpr LimitationKind hard_shadows{"hard_shadows", "size ignored: shadows in the fog have hard edges"};
}

// The media, each with the extinction of its most strongly attenuated color channel.
std::vector<Medium> thickest_media(const Snapshot& snapshot);

// Reports media thick enough for multiple scattering to show, ambient light that nothing shadows, and places so far
// from the origin that floats do not resolve them.
void add_single_scattering(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Reports grids so dense that light changes strongly within a cell of a light grid with `cells` cells across the fog.
void add_light_grid_cells(const Snapshot& snapshot, int cells, Limitations& limitations);

// Camera rays through the center and near the corners of the image, up to the end of the fog within the scene's bounds.
// If none meets that: up to fog_reach(), where fog becomes opaque.
std::vector<Ray> probing_rays(const View& view, const Snapshot& snapshot);

// Reports media for which `steps` steps along a ray are too few to resolve a grid's detail; if the number is `fixed`,
// also those too dense for such steps.
void add_steps(const View& view, const Snapshot& snapshot, int steps, bool fixed, Limitations& limitations);

// Optical depth of a step or froxel beyond which it attenuates most of the light that crosses it, so that results
// depend on where the sample falls.
inline constexpr float dark_depth = 2;

// Reports lights whose attenuation by fog is off or averaged.
void add_light_transmittance(const Snapshot& snapshot, LightTransmittance light, Limitations& limitations);

// Reports what a fluence grid for multiple scattering cannot show, unshadowed ambient light, and float precision.
void add_fluence(const View& view, const Snapshot& snapshot, const FluenceSettings& settings, Limitations& limitations);

// Reports the time samples of motion blur, and volumes that do not move within them.
void add_shutter(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Report media whose albedo or emission grid is reduced to its mean color.
void add_mean_albedo(const Snapshot& snapshot, Limitations& limitations);
void add_mean_emission(const Snapshot& snapshot, Limitations& limitations);

// Relative errors that are visible, and that make an image wrong.
inline constexpr double seen_share = 0.02, wrong_share = 0.5;

// Whether a medium scatters light: not purely emissive, and albedo above 0.
bool scatters_light(const Medium& medium);
}
