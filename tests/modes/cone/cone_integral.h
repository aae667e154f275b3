// The light of one light in homogeneous fog along a ray, by adaptive quadrature in double of the equation as it is
// written down: the truth for the `cone` mode.
#pragma once
#include "modes/settings.h"
#include "scene/light.h"
#include "scene/lights/light_reach.h"
#include "volume/medium.h"

#include <functional>
#include <span>
#include <vector>

namespace tyndall::test {
// ∫ σ p T dt of a unit of the light's intensity; media axis-aligned boxes of homogeneous or height fog.
double cone_integral(const Light& light, std::span<const Medium> media, const Ray& ray);
}
