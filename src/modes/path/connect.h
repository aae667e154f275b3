// From a point of a path to a light: what surfaces and fog leave of it.
#pragma once
#include "modes/path/tracer.h"
#include "volume/tracking.h"

#include <vector>

namespace tyndall {
struct Connection {
    vec3 point{0};        // where light is scattered
    vec3 face_normal{0};  // of a surface point, towards the viewer; 0 in fog
    vec3 to_light{0};     // unit, to the light's centre: the way through the fog
    float fog_length = 0; // of that way, infinite for the sun
    vec3 shadow{0};       // unit, to a point of the light: the way of the shadow ray
    float shadow_length = 0;
    bool shadows = true;
    int casters = -1;     // set of the snapshot whose surfaces may be in the way; -1 = all
    vec3 light{0};        // what reaches the eye if nothing is in the way
    vec3 irradiance{0};   // of a light with a face: what arrives from it by this connection, facing it
    float steradians = 0; // likewise: one over the chance per steradian of the way
    int light_index = -1; // of the snapshot; -1 = none of its lights, but the next
    OtherLight other = OtherLight::emission;
    size_t lane = 0;     // of the batch
    bool in_fog = false; // the path's first event was in fog
    RandomStream random;
};

// From a point to a light of the snapshot; `u` picks the point of a soft light. To one with a face it goes to that
// point, also through the fog.
Connection connection_to_light(const PathTracer& tracer, vec3 point, int light, vec3 to_light, vec2 u);

// From a point to a point on a glowing surface.
Connection connection_to_glow(vec3 point, const EmissivePoint& target);

// From a point to a place in glowing fog.
Connection connection_to_fire(vec3 point, const EmissivePlace& target);

// From a point to where the environment's light comes from.
Connection connection_to_sky(const Environment& environment, vec3 point, vec3 direction);

// Share of light that surfaces let through, of up to 16 connections; 1 for dark ones and lights without shadows.
void find_visibility(const PathTracer& tracer, std::span<const Connection> connections, float* visibility);

// Adds what each connection brings to the results, and, where it is scattered in fog, to the batch's parts. Empties the
// list.
void connect(const PathTracer& tracer, std::vector<Connection>& connections, const RayBatch& batch,
             std::span<Scatter> results);
}
