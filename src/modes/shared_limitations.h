// Limitations that several techniques share, and what finds them.
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

// The media, each as the channel meets it that it dims most.
std::vector<Medium> thickest_media(const Snapshot& snapshot);

// Where a medium is so thick that light scattered more than once shows, ambient light that nothing shadows, and places
// so far from the origin that floats do not resolve them.
void add_single_scattering(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Where fog dims the light to it within a cell of a light grid that has so many cells across the fog.
void add_light_grid_cells(const Snapshot& snapshot, int cells, Limitations& limitations);

// Rays through the middle and towards the corners of the image, to the end of fog and scene; of unbounded fog that the
// scene takes no part of, to where nothing is seen through it.
std::vector<Ray> probing_rays(const View& view, const Snapshot& snapshot);

// Where so many steps along a ray are too few for the detail of a grid; with `fixed`, for its light in thick fog too.
void add_steps(const View& view, const Snapshot& snapshot, int steps, bool fixed, Limitations& limitations);

// Optical depths of a step or a froxel that take most of the light that falls on them: what is seen is by chance.
inline constexpr float dark_depth = 2;

// Where lights are dimmed by less than the fog they cross.
void add_light_transmittance(const Snapshot& snapshot, LightTransmittance light, Limitations& limitations);

// What a grid of light that has been scattered before cannot show; ambient light too.
void add_fluence(const View& view, const Snapshot& snapshot, const FluenceSettings& settings, Limitations& limitations);

// What motion blur is made of, and what does not move in it.
void add_shutter(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Where colors of grids count with their mean: of what scatters, and of what emits.
void add_mean_albedo(const Snapshot& snapshot, Limitations& limitations);
void add_mean_emission(const Snapshot& snapshot, Limitations& limitations);

// Of what is off: a share that shows, and one that is wrong.
inline constexpr double seen_share = 0.02, wrong_share = 0.5;

// Whether a medium sends light of others on.
bool scatters_light(const Medium& medium);
}
