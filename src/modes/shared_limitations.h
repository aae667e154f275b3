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
inline constexpr LimitationKind mean_environment{
    "mean_environment", "in the fog its light is its mean from all around, shadowed by nothing: some {}% off what "
                        "the fog scatters of {} nits"};
inline constexpr LimitationKind environment_left_out{"environment_left_out",
                                                     "its light in the fog is left out: {} nits from all around"};
inline constexpr LimitationKind lamp_for_face{
    "lamp_for_face", "in the fog it shines from its middle, as a lamp of {} m radius: off by more than 10% within {} m "
                     "of it"};
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
inline constexpr LimitationKind out_of_gamut{
    "out_of_gamut",
    "{}% of its light, below {n} K, is redder than Rec.709 can be: shown as red as can be at its luminance"};
inline constexpr LimitationKind unscattered_emission{
    "unscattered_emission", "its light is seen and lights nothing: {} lumens are not scattered (path follows them)"};
inline constexpr LimitationKind lamps_for_fire{
    "lamps_for_fire", "in the fog its light is off by more than 10% within {} m of the {n} lamps that stand for it"};
inline constexpr LimitationKind lamps_for_surfaces{
    "lamps_for_surfaces",
    "in the fog its light is off by more than 10% within {} m of the {n} lamps that stand for glowing surfaces"};
inline constexpr LimitationKind emission_lights_nothing{
    "emission_lights_nothing", "emission of surfaces with holes or alpha is visible but lights nothing else"};
inline constexpr LimitationKind emission_lights_no_fog{
    "emission_lights_no_fog", "its emission lights surfaces, but what fog scatters of it is left out"};
inline constexpr LimitationKind emission_left_out{"emission_left_out", "its light is left out: {} lumens"};
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

// What Rec.709 cannot show of the light of fog, and with `lights_nothing` how much of it lights nothing because it
// comes from no grid.
void add_emission(const Snapshot& snapshot, bool lights_nothing, Limitations& limitations);

// Where lamps stand for glowing fog. `wrong` where most of their light is scattered in the fog that they are off in.
void add_lamps_for_fire(const Snapshot& snapshot, Limitations& limitations);

// Where lamps stand for surfaces that emit.
void add_lamps_for_surfaces(const Snapshot& snapshot, Limitations& limitations);

// Where the fog has the environment's light as its mean, or none of it. How far the mean is off is measured on a few
// rays.
void add_mean_environment(const View& view, const Snapshot& snapshot, Limitations& limitations);
void add_left_out_environment(const Snapshot& snapshot, Limitations& limitations);

// Where lamps stand for the faces of rectangles, discs and spheres. `wrong` also where that fog takes much of the
// picture.
void add_lamps_for_faces(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Materials whose emission lights nothing; and those for which it does so in the fog alone.
void add_dark_emission(const Snapshot& snapshot, Limitations& limitations);
void add_unscattered_surfaces(const Snapshot& snapshot, Limitations& limitations);

// Where the light of fog is not drawn at all.
void add_left_out_emission(const Snapshot& snapshot, Limitations& limitations);
}
