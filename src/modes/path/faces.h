// Multiple importance sampling of area lights: light sampling and, where the phase function is narrower than a face,
// directions sampled by the phase function.
#pragma once
#include "modes/path/vertex.h"

namespace tyndall {
// Peak of the phase function at a point, 1/sr, if directions sampled by it look for the face of some light; else 0.
float peak_for_faces(const PathTracer& tracer, const FogPoint& fog);

// MIS weight of light sampling at a point with such a peak; `cosine`: between the connection and the line.
float mis_weight(const PathState& state, const FogPoint& fog, const Connection& connection, float peak, float cosine);

// Adds the light of faces that the current segment of a line hits, with its MIS weight.
void hit_faces(const PathState& state, Segment& line);
}
