// Limitations of light that comes from more than a point: skies, faces, fire and surfaces that emit.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind mean_environment{
    "mean_environment", "in the fog its light is its mean from all around, shadowed by nothing: some {}% off what "
                        "the fog scatters of {} nits"};
inline constexpr LimitationKind environment_left_out{"environment_left_out",
                                                     "its light in the fog is left out: {} nits from all around"};
inline constexpr LimitationKind lamp_for_face{
    "lamp_for_face", "in the fog it shines from its middle, as a lamp of {} m radius: off by more than 10% within {} m "
                     "of it"};
inline constexpr LimitationKind out_of_gamut{
    "out_of_gamut", "{}% of its light, below {n} K, is redder than Rec.709 can be: shown as red as can be"};
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
}

// What Rec.709 cannot show of the light of fog, and with `lights_nothing` how much of it lights nothing because it
// comes from no grid.
void add_emission(const Snapshot& snapshot, bool lights_nothing, Limitations& limitations);

// Where lamps stand for glowing fog. `wrong` where most of their light is scattered in the fog that they are off in.
void add_lamps_for_fire(const Snapshot& snapshot, Limitations& limitations);

// Where lamps stand for surfaces that emit; `wrong` as of faces.
void add_lamps_for_surfaces(const View& view, const Snapshot& snapshot, Limitations& limitations);

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
