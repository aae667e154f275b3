// How beam cards are off.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind cards{"cards", "cards are artistic: not lit, not shadowed, not made of fog"};
inline constexpr LimitationKind camera_in_card{"camera_in_card", "the camera is inside: it fades out"};
inline constexpr LimitationKind card_edge_on{"card_edge_on", "seen along the beam, where a card is thin: it fades out"};
inline constexpr LimitationKind open_light{
    "open_light", "shines in the open: cards stand in openings only, the rest is haze without shadows"};
inline constexpr LimitationKind no_opening{"no_opening", "no opening found that it shines through: no card"};
inline constexpr LimitationKind no_fog{"no_fog", "there is no fog for cards to show"};
inline constexpr LimitationKind homogeneous_in_cards{"homogeneous_in_cards",
                                                     "seen as homogeneous fog, through the cards only"};
}

Limitations billboard_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}
