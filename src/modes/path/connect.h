// Connections from a point of a path to a light (next-event estimation), attenuated by surfaces and fog.
#pragma once
#include "modes/path/tracer.h"
#include "volume/tracking.h"

#include <vector>

namespace tyndall {
struct Connection {
    vec3 point{0};        // where light is scattered
    vec3 face_normal{0};  // of a surface point, towards the viewer; 0 in fog
    vec3 to_light{0};     // unit, to the light's center: direction through the fog
    float fog_length = 0; // length in that direction, infinite for suns
    vec3 shadow{0};       // unit, to a point of the light: direction of the shadow ray
    float shadow_length = 0;
    bool shadows = true;
    int casters = -1;     // casters that may block the light: a set of the snapshot; -1 = all
    vec3 light{0};        // radiance at the eye if nothing is in the way
    vec3 irradiance{0};   // for an area light: irradiance of this sample, facing the light
    float steradians = 0; // likewise: reciprocal of the direction's pdf, sr
    int light_index = -1; // of the snapshot; -1 = none, see `other`
    OtherLight other = OtherLight::emission;
    size_t lane = 0;     // of the batch
    bool in_fog = false; // the path's first event was in fog
    RandomStream random;
};

// A connection to a light of the snapshot; `u` samples a point of a soft light. For an area light, the path through the
// fog ends at that point too.
Connection connection_to_light(const PathTracer& tracer, vec3 point, int light, vec3 to_light, vec2 u);

// A connection to a point on an emissive surface.
Connection connection_to_emitter(const Snapshot& snapshot, vec3 point, const EmissivePoint& target);

// A connection to a point in emissive fog.
Connection connection_to_fire(vec3 point, const EmissionSample& target);

// A connection to the environment in a given direction.
Connection connection_to_sky(const Environment& environment, vec3 point, vec3 direction);

// Fraction of light that surfaces let through, for up to 16 connections; 1 for those without light and for lights
// without shadows.
void find_visibility(const PathTracer& tracer, std::span<const Connection> connections, float* visibility);

// Adds the light of each connection to the results and, if it is scattered in fog, to the batch's parts. Clears the
// list.
void connect(const PathTracer& tracer, std::vector<Connection>& connections, const RayBatch& batch,
             std::span<Scatter> results);
}
