// Light scattered at points of a ray, attenuated on its way from the light to them.
#pragma once
#include "integrate/lights/light_along.h"
#include "integrate/single_scattering/single_scattering.h"

namespace tyndall {
// A point of the ray, and its contribution before attenuation of the light on its way there.
struct LitNode {
    dvec3 position, light;
};

// The sum of one light's nodes, attenuated by surfaces with alpha and fog between them and the light, 16 at a time.
struct LitNodes {
    const SingleScattering& frame;
    const LightDepth& depth; // of the light
    const LightAlong& along;
    dvec3 sum{0};
    int work = 0; // steps towards the light
    int count = 0;
    LitNode pending[16]{};

    void add(const LitNode& node) {
        pending[count++] = node;
        if (count == 16) attenuate();
    }

    // Adds about `wanted` of the nodes, drawn in proportion to their contribution: the expected value over jitters in
    // [0,1) is the sum of all.
    void add_drawn(std::span<const LitNode> nodes, int wanted, float jitter);

    // Adds what is pending to the sum.
    void attenuate();
};
}
