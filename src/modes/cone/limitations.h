// Limitations of cone.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind no_shadows{
    "no_shadows", "shadows of surfaces are ignored: an error of about {}% in its light in fog"};
inline constexpr LimitationKind point_light_only{"point_light_only",
                                                 "treated as a point light; the radius only caps the brightness"};
inline constexpr LimitationKind unphysical_attenuation{"unphysical_attenuation",
                                                       "cone.attenuation is not inverse_square: not physical"};
inline constexpr LimitationKind inner_cone_ignored{"inner_cone_ignored",
                                                   "cone.edge is soft: the light's own inner cone is ignored"};
inline constexpr LimitationKind cut_near_light{"cut_near_light",
                                               "cone.near_radius removes the light close to the lamp"};
inline constexpr LimitationKind artistic_noise{"artistic_noise",
                                               "cone.noise modulates the light: artistic, not physical"};
}

Limitations cone_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}
