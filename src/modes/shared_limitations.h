// Limitations that several techniques share, and the functions that detect them.
#pragma once
#include "base/math.h"
#include "modes/limitation.h"
#include "trace/transmittance/light_transmittance.h"

namespace tyndall {
struct Medium;
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind single_scattering_only{
    "single_scattering_only", "single scattering only: with up to {} optical depths of scattering, real fog is "
                              "brighter and softer (--orders all adds multiple scattering in march and froxel)"};
inline constexpr LimitationKind float_precision{
    "float_precision", "float precision at this distance from the origin is {} m: edges and shadows are no finer"};
inline constexpr LimitationKind light_grid_cells{
    "light_grid_cells", "cells of the light grid are up to {} optical depths deep: light in dense parts is blurred"};
inline constexpr LimitationKind long_steps{
    "long_steps",
    "steps of about {} m are longer than a voxel ({} m): fine detail is blurred or noisy; more steps resolve it"};
inline constexpr LimitationKind deep_steps{"deep_steps",
                                           "steps are up to {} optical depths deep (about {} m): attenuation within a "
                                           "step is not resolved; more steps resolve it"};
inline constexpr LimitationKind cached_fluence{"cached_fluence",
                                               "multiple scattering is cached in cells of {} m: it has no finer "
                                               "detail, and may leak around corners within a cell"};
inline constexpr LimitationKind table_by_mean_cosine{
    "table_by_mean_cosine",
    "multiple scattering uses only the mean cosine of its phase function: at 90 degrees {} times the tabulated value"};
inline constexpr LimitationKind fog_scatters_alone{
    "fog_scatters_alone", "multiple scattering is computed in fog only: surfaces receive only direct light; light of "
                          "fire and emissive surfaces is scattered further as if from lamps, ambient light and "
                          "emission that follows the density are not"};
inline constexpr LimitationKind unbounded_fluence{
    "unbounded_fluence", "in unbounded fog, multiple scattering is computed in and around the scene only"};
inline constexpr LimitationKind orders_left_out{"orders_left_out", "scattering orders above {n} are ignored"};
inline constexpr LimitationKind drawn_as_homogeneous{"drawn_as_homogeneous",
                                                     "rendered as homogeneous fog of its mean density"};
inline constexpr LimitationKind mean_emission_color{"mean_emission_color",
                                                    "its emission is rendered in its mean color, an average error of "
                                                    "{}%, and its brightness is interpolated linearly between voxels"};
inline constexpr LimitationKind mean_albedo{"mean_albedo",
                                            "its albedo is replaced by its mean color, an average error of {}%"};
inline constexpr LimitationKind shutter_moments{
    "shutter_moments", "motion of up to {} pixels between two of the {n} time samples of motion blur (--time-samples)"};
inline constexpr LimitationKind sun_disc{"sun_disc",
                                         "fog right in front of it is up to {}% too bright: its disc of {} degrees "
                                         "softens shadows only; surfaces and phase functions see its center"};
inline constexpr LimitationKind still_volumes{
    "still_volumes", "has one file per frame, so it does not move during the {} s of the open shutter (a \"velocity\" "
                     "in its \"grids\" moves it, \"blend\" in its \"sequence\" blends files)"};
inline constexpr LimitationKind blended_volumes{
    "blended_volumes", "two of its files are blended while the shutter is open, with up to {}% of the lesser: features "
                       "that move more than a voxel between files appear twice"};
inline constexpr LimitationKind advected_volumes{"advected_volumes",
                                                 "moved along straight lines by its velocities, up to {} voxels from "
                                                 "its position in the file, through {n} positions"};
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

// Reports media for which `steps` equal steps along a ray are too few: to resolve a grid's detail, or dense fog.
void add_steps(const View& view, const Snapshot& snapshot, int steps, Limitations& limitations);

// Optical depth of a step or froxel beyond which it attenuates most of the light that crosses it, so that results
// depend on where the sample falls.
inline constexpr float dark_depth = 2;

// Reports lights whose attenuation by fog is off or averaged.
void add_light_transmittance(const Snapshot& snapshot, LightTransmittance light, Limitations& limitations);

// Reports what a fluence grid for multiple scattering cannot show, unshadowed ambient light, and float precision.
void add_fluence(const View& view, const Snapshot& snapshot, const Settings& settings, Limitations& limitations);

// Reports what holds in every mode: the time samples of motion blur, volumes that do not move within them, and suns
// whose disc would show in a narrow phase function.
void add_to_every_mode(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Report media whose albedo or emission grid is reduced to its mean color.
void add_mean_albedo(const Snapshot& snapshot, Limitations& limitations);
void add_mean_emission(const Snapshot& snapshot, Limitations& limitations);

// The severity of a relative RMS error.
inline constexpr double visible_error = 0.02, wrong_error = 0.5;
constexpr Severity severity_of(double error) {
    return error > wrong_error ? Severity::wrong : error > visible_error ? Severity::degraded : Severity::info;
}

// Whether a medium scatters light: not purely emissive, and albedo above 0.
bool scatters_light(const Medium& medium);
}
