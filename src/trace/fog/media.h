// Media of a scene at one moment.
#pragma once
#include "trace/snapshot.h"

namespace tyndall {
struct FogRecipe;
struct MediumSource;

// Extinction of fog that only emits, 1/m. Kernels divide emission by extinction and later multiply by it, so any value
// works that is negligible over the longest path.
inline constexpr float min_extinction = 1e-20f;

// Fills media, fog_sources and notes of `snapshot`. Media that neither attenuate nor emit light are left
// out. Reuses bricks of `previous` (may be null) made from the same file or recipe. Throws Error.
void add_media(const Scene& scene, Moment moment, const Snapshot* previous, MissingFrame missing, Snapshot& snapshot);

// The recipe that a medium is generated from, and a key of its state at a moment: equal keys mean equal fog.
FogRecipe medium_recipe(const MediumSource& source);
std::string recipe_key(const FogRecipe& recipe, double seconds);

// Approximate speed at which a recipe's fog changes, meters per second: by wind or rising fire, by noise gradients that
// evolve through one cell per turn, and by swirl. 0 = static fog, generated once.
float recipe_speed(const FogRecipe& recipe);
}
