// IES profiles and gobos in techniques that cannot represent them fully.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Light;
struct Snapshot;

namespace limitation {
inline constexpr LimitationKind sampled_gobo{"sampled_gobo",
                                             "its gobo or IES profile has {} texels or angles per sample along a ray: "
                                             "edges are noisy; more samples resolve them"};
inline constexpr LimitationKind blurred_filter{"blurred_filter",
                                               "detail of its IES profile or gobo finer than {} degrees is lost"};
inline constexpr LimitationKind mean_filter{
    "mean_filter",
    "its IES profile, gobo or cosine emission is replaced by its mean; the standard deviation is {} times that mean"};
}

// Replaces each light's filter by its mean, equal in all directions.
void average_filters(Snapshot& snapshot);

void add_mean_filters(const Snapshot& snapshot, Limitations& limitations);

// Reports filters that rays sample at `nodes` jittered nodes across a light's beam: gobos too fine for quadrature, or
// all filters, other than the cosine emission of faces.
enum class Sampled { fine_gobos, all_filters };
void add_sampled_filters(const Snapshot& snapshot, Sampled which, double nodes, Limitations& limitations);

// Reports a profile or gobo with detail finer than `angle`, radians, which is blurred.
void add_blurred_filter(const Light& light, float angle, Limitations& limitations);
}
