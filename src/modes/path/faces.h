// Faces of lights are aimed at; where fog scatters more narrowly than a face is wide, the directions that paths take
// find it as well. Both share its light (multiple importance sampling).
#pragma once
#include "modes/path/vertex.h"

namespace tyndall {
// The largest value of the phase function at a point, 1/sr, where it finds the face of some light; else 0.
float peak_for_faces(const PathTracer& tracer, const FogPoint& fog);

// Share of what aiming at a light brings to a point with such a peak that is not left to the phase function, whose
// direction there has a cosine with the line.
float aimed_share(const Walk& walk, const FogPoint& fog, const Connection& connection, float peak, float cosine);

// Adds the light of the faces on the current stretch of a line that looks for them.
void meet_faces(const Walk& walk, Segment& line);
}
