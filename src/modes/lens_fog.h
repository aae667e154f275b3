// Fog behind a lens, for techniques that know the fog of one eye only: they see it through the middle of the lens.
#pragma once
#include "integrate/ray_batch.h"
#include "modes/limitation.h"

namespace tyndall {
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind fog_through_middle{
    "fog_through_middle",
    "its fog lacks a blur of up to {} pixels (at {} m): it is seen through the middle of the lens"};
inline constexpr LimitationKind no_fog_picture{
    "no_fog_picture", "does nothing: through a lens the fog of every ray is computed by itself"};
}

// Asks for rays from the middle of the lens that meet those given in the plane in focus, and begin and end as deep as
// they; `scatter` itself where the camera has no lens.
ScatterFunction through_middle(const View& view, ScatterFunction scatter);

// How wide the discs of lamps in the picture and of the far end of the fog would be. For techniques that take fog
// through the middle.
void add_fog_through_middle(const View& view, const Snapshot& snapshot, Limitations& limitations);

// For techniques that look fog up in a picture of it: that a row of theirs is in vain.
void add_no_fog_picture(const View& view, const char* row, Limitations& limitations);
}
