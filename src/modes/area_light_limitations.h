// Limitations for light from more than a point: environments, area lights, fire and emissive surfaces.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind mean_environment{
    "mean_environment", "its light in fog is replaced by its unshadowed mean: an error of about {}% (mean {} nits)"};
inline constexpr LimitationKind environment_left_out{"environment_left_out",
                                                     "its light is ignored in fog (mean {} nits)"};
inline constexpr LimitationKind lamp_for_face{
    "lamp_for_face", "approximated in fog by a lamp of {} m radius at its center: error above 10% within {} m"};
inline constexpr LimitationKind out_of_gamut{
    "out_of_gamut", "{}% of its light, below {n} K, is outside the Rec.709 gamut: clamped to the reddest color"};
inline constexpr LimitationKind unscattered_emission{
    "unscattered_emission",
    "its emission illuminates surfaces but no fog: up to {}% of its light is missing; march and path include it"};
inline constexpr LimitationKind lamps_for_fire{
    "lamps_for_fire", "its light in fog has an error above 10% within {} m of the {n} lamps that approximate it"};
inline constexpr LimitationKind lamps_for_surfaces{
    "lamps_for_surfaces",
    "its light in fog has an error above 10% within {} m of the {n} lamps that approximate emissive surfaces"};
inline constexpr LimitationKind emission_lights_no_fog{"emission_lights_no_fog",
                                                       "its emission illuminates surfaces, but is ignored in fog"};
inline constexpr LimitationKind fire_left_out{"fire_left_out", "its fire is ignored: {} lumens"};
inline constexpr LimitationKind emission_left_out{"emission_left_out", "its emission is ignored: at most {} nits"};
inline constexpr LimitationKind ambient_left_out{"ambient_left_out", "ambient light is ignored in fog: {} nits"};
}

// Reports emission of media outside the Rec.709 gamut.
void add_out_of_gamut(const Snapshot& snapshot, Limitations& limitations);

// Reports fire and thin fog that emits, which lamps approximate: `wrong` where fog scatters much of their light within
// the distance at which they are inaccurate. Reports unbounded and thick fog that emits, for which there are none.
void add_lamps_for_fire(const Snapshot& snapshot, Limitations& limitations);

// Reports emissive surfaces approximated by lamps; `wrong` as in add_lamps_for_faces().
void add_lamps_for_surfaces(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Reports an environment whose light in fog is reduced to its mean (error measured on a few rays).
void add_mean_environment(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Reports area lights (rectangles, disks, spheres) approximated by lamps. `wrong` where fog scatters much of their
// light within the distance at which they are inaccurate, or where that region covers much of the image.
void add_lamps_for_faces(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Reports what is ignored in fog where only lamps illuminate it: media and surfaces that emit, ambient light and an
// environment.
void add_left_out_light(const Snapshot& snapshot, bool surfaces_emit, Limitations& limitations);
}
