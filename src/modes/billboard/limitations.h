// Limitations of billboard.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind cards{
    "cards", "beam cards are artistic: they are neither lit nor shadowed, and ignore the fog around them"};
inline constexpr LimitationKind camera_in_card{"camera_in_card", "the camera is inside: the card fades out"};
inline constexpr LimitationKind card_edge_on{"card_edge_on", "seen along the beam, where a card is thin: faded out"};
inline constexpr LimitationKind open_light{
    "open_light", "not behind an opening: cards show beams through openings only, the rest is haze without shadows"};
inline constexpr LimitationKind no_opening{"no_opening", "no opening found for the light to shine through: no card"};
inline constexpr LimitationKind no_fog{"no_fog", "has no fog for cards to show"};
inline constexpr LimitationKind homogeneous_in_cards{"homogeneous_in_cards",
                                                     "rendered as homogeneous fog, on the cards only"};
}

Limitations billboard_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}
