// Light that fog emits on a segment of a line.
#pragma once
#include "modes/path/vertex.h"

namespace tyndall {
// Interval of a medium on the segment, and 1 for the channels in which it is so thin there that paths rarely collide
// with it; 0 for the others.
struct ThinPart {
    Interval<float> range;
    vec3 channels{0};
};
ThinPart thin_part(const Segment& line, const Medium& medium);

// Pdf, 1/m, with which a path finds a point of the fire by colliding there, scaled for MIS against other techniques.
float collision_pdf(const Snapshot& snapshot, vec3 position, int& lookups);

// Adds emission of thin fog at one sampled distance per medium; thicker fog emits at collisions.
void gather_emission(const PathState& state, Segment& line);

// Adds the emission of fire at a collision of the path at a distance along the segment.
void gather_fire_at_collision(const PathState& state, Segment& line, float distance, const FogPoint& fog);
}
