// Ambient light in techniques that cannot shadow it.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind unshadowed_ambient{
    "unshadowed_ambient",
    "ambient light is not shadowed: surfaces and fog would block about {} % of it in the visible fog"};
}

// Fraction of the ambient light that surfaces and fog would block in the visible fog, estimated from 32 points; 0
// without fog.
double blocked_ambient(const View& view, const Snapshot& snapshot);

// Reports ambient light in the scene, with that fraction.
void add_unshadowed_ambient(const View& view, const Snapshot& snapshot, Limitations& limitations);
}
