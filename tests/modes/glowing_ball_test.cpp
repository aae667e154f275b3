// A ball that only emits, by a grid of temperatures, in each convention: emission times chord, and what its own smoke
// leaves of that.
#include "modes/fire_scenes.h"
#include "volume/emission/blackbody.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr float hot = 1500;                              // kelvin; halves hold it
constexpr double scale = 0.25;                           // emission_scale, 1/m
constexpr double radius = 1.5, edge = 0.4, voxel = 0.05; // meters
const dvec3 middle(2), tint(1, 0.5, 1);

SparseVolume grid(const std::function<float(ivec3)>& value) {
    SparseVolume volume = tenth_volume(ivec3(80), value);
    volume.index_to_world = glm::scale(dmat4(1), dvec3(voxel));
    return volume;
}

// 1 inside the ball, falling evenly over its edge: the mean of balls with radii from R - edge/2 to R + edge/2.
constexpr double inner = radius - edge / 2, outer = radius + edge / 2;
float coverage(ivec3 at) {
    const double off = glm::distance(voxel * dvec3(at), middle);
    return static_cast<float>(std::clamp((outer - off) / edge, 0.0, 1.0));
}

// Its integral along a line at a distance from the middle: the mean of the chords 2 √(r² - off²).
double chord(double off) {
    const auto integral = [&](double r) { return r * std::sqrt(r * r - off * off) - off * off * std::acosh(r / off); };
    return off < outer ? (integral(outer) - integral(std::max(inner, off))) / edge : 0;
}

// What linear interpolation between voxels adds to that, on average: the integral of h²/12 Δ(coverage).
double interpolated(double off) {
    const auto kink = [&](double r) { return r / std::sqrt(r * r - off * off); };
    const double slope = 2 * (std::acosh(outer / off) - std::acosh(inner / off));
    return off < inner ? voxel * voxel / 6 / edge * (kink(outer) - kink(inner) - slope) : 0;
}

struct Convention {
    const char* name;
    BlackbodyKind kind;
    bool by_absorption;
};

// Hot everywhere; the ball is its smoke, and its flame where emission does not follow the smoke.
MediumSource ball(const TempFolder& scratch, const Convention& convention, double extinction) {
    const SparseVolume shape = grid(coverage);
    MediumSource source = grid_source(scratch, "ball", shape, static_cast<float>(extinction));
    source.temperature = property(scratch, "temperature", grid([](ivec3) { return hot; }));
    if (!convention.by_absorption) source.flame = property(scratch, "flame", shape);
    source.blackbody = BlackbodySource{.kind = convention.kind, .scale = float(scale), .tint = vec3(tint)};
    source.blackbody->by_absorption = convention.by_absorption;
    return source;
}

// j/σ (1 - e^-τ): without smoke the emission j times the chord. What emits as it absorbs has j/σ by its temperature.
TEST(GlowingBall, IsEmissionTimesChordLessWhatItsSmokeAbsorbs) {
    const TempFolder scratch;
    for (const Convention& convention : {Convention{"kelvin", BlackbodyKind::kelvin, false},
                                         {"kelvin with kirchhoff", BlackbodyKind::kelvin, true},
                                         {"cycles", BlackbodyKind::cycles, false},
                                         {"pbrt", BlackbodyKind::pbrt, true}})
        for (const double extinction : {convention.by_absorption ? 1e-3 : 0.0, 0.8}) {
            Scene scene;
            const Snapshot snapshot = snapshot_with(scene, ball(scratch, convention, extinction));
            for (const double off : {1e-3, 0.7, 1.2, 1.9}) {
                const double depth = extinction * chord(off), absorbed = -std::expm1(-depth);
                const double length = convention.by_absorption ? absorbed
                                      : extinction > 0         ? absorbed / extinction
                                                               : chord(off);
                const Ray ray{vec3(middle + dvec3(0.6 * off, 0.8 * off, -4)), {0, 0, 1}, 10};
                expect_along(snapshot, ray, scale * length * tint * blackbody_color(convention.kind, hot),
                             convention.name + (" at " + std::to_string(off)) + " in " + std::to_string(extinction) +
                                 "/m",
                             1e-3 - 2 * interpolated(off) / (off < outer ? chord(off) : 1));
            }
        }
}
}
}
