// Media of a scene at one moment.
#pragma once
#include "trace/snapshot.h"

namespace tyndall {
struct FogRecipe;
struct MediumSource;

// Of fog that emits and dims nothing, 1/m. Kernels divide emission by extinction, and multiply by it again: any value
// does that is nothing over the longest way.
inline constexpr float min_extinction = 1e-20f;

// Fills media, fog_sources and notes of `snapshot`. Media without extinction are left out. `previous` (may be null)
// lends bricks made from the same file or recipe. Throws Error.
void add_media(const Scene& scene, Moment moment, const Snapshot* previous, MissingFrame missing, Snapshot& snapshot);

// The recipe that a medium is grown from, and what it is at a moment: the same key, the same fog.
FogRecipe grown_recipe(const MediumSource& source);
std::string growth_key(const FogRecipe& recipe, double seconds);

// How fast fog of a recipe changes, metres per second, about: by wind or the rise of its fire, by swirls around their
// middle, and by gradients that evolve through a cell a turn. 0 where it stands still: it is grown once.
float recipe_speed(const FogRecipe& recipe);

// The smallest box around an affinely moved box; unbounded directions stay so.
Box moved_box(const mat4& matrix, const Box& box);
}
