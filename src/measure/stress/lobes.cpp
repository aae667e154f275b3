// Phase functions with lamps and suns: lobes that get narrow, two lobes, droplets, spikes of tables.
#include "measure/stress/authored.h"
#include "modes/froxel/limitations.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
// One sample per step: where a lobe fills a fifth of the step, the relative error is sqrt(1 / 0.2 - 1) = 2.
const std::vector<Excuse> excuses{{&limitation::few_steps_for_glow, 2},
                                  {&limitation::coarse_glow},
                                  {&limitation::deep_froxels},
                                  {&limitation::deep_steps},
                                  {&limitation::coarse_shafts},
                                  {&limitation::grainy_edges, 1.5},
                                  shadows_ignored};

// Looking past a lamp that shines towards the eye.
StressScene past_lamp(const Phase& phase, float extinction = 0.2f) {
    return stress_scene({thin_haze(extinction, phase)}, {point_light({0.5f, 0.4f, -1}, 10)},
                        camera_from({0, 0, 3}, vec3(0)));
}
StressScene past_sun(const Phase& phase) {
    return stress_scene({thin_haze(0.2f, phase)}, {sun_light({0.2f, -0.3f, 1}, 10)}, camera_from({0, 0, 3}, vec3(0)));
}

Phase two_lobes(double share) {
    return mixed_phase(share, {PhaseKind::henyey_greenstein, 0.9f}, {PhaseKind::henyey_greenstein, -0.8f});
}

// A forward spike of half the light within `degrees`, on a constant floor.
Phase spiked(double degrees) {
    PhaseTableNotes notes;
    const double spike = 2 / (1 - std::cos(glm::radians(degrees)));
    const std::vector<PhaseEntry> entries{{0, spike}, {degrees, spike}, {1.2 * degrees, 1}, {180, 1}};
    return table_phase(PhaseKind::table, make_table(std::span(entries), notes));
}

StressScene draine(double g) { return past_lamp(draine_phase(g, 4)); }
StressScene droplets(double diameter) { return past_lamp(mie_phase(diameter)); }
StressScene lobes_of_lamp(double share) { return past_lamp(two_lobes(share)); }
StressScene lobes_of_sun(double share) { return past_sun(two_lobes(share)); }
StressScene spike_of_lamp(double degrees) { return past_lamp(spiked(degrees)); }
StressScene spike_of_sun(double degrees) { return past_sun(spiked(degrees)); }
StressScene rayleigh(double extinction) { return past_lamp({PhaseKind::rayleigh}, static_cast<float>(extinction)); }

// Droplets in a shaft through a slit.
StressScene droplets_in_shaft(double diameter) {
    return stress_scene(
        {thin_haze(0.15f, mie_phase(diameter))}, {sun_light({0.4f, -0.7f, 0.5f}, 10)}, camera_from({0, 0, 7}, vec3(0)),
        {quad({-20, 2, -20}, {19.7f, 0, 0}, {0, 0, 40}, 0), quad({0.5f, 2, -20}, {19.5f, 0, 0}, {0, 0, 40}, 0)},
        {lambert(vec3(0))});
}
}

std::vector<StressCase> stress_lobes() {
    constexpr std::string_view group = "phase functions";
    const StressMeasure usual = default_measure();
    return {
        StressCase("rayleigh-lamp", group, "a lamp in Rayleigh-scattering fog that gets thick", "extinction", "1/m",
                   {0.02, 0.2, 0.6}, Claim::physical, excuses, rayleigh, usual),
        StressCase("draine-lamp", group, "a lamp through a Draine lobe that gets narrow", "g", "", {0.2, 0.7, 0.95},
                   Claim::physical, excuses, draine, usual),
        StressCase("droplets-lamp", group, "a lamp through droplets of growing size", "diameter", "micrometers",
                   {5, 15, 50}, Claim::physical, excuses, droplets, usual),
        StressCase("two-lobes-lamp", group, "a lamp through two lobes", "share of the forward lobe", "", {0, 0.5, 1},
                   Claim::physical, excuses, lobes_of_lamp, usual),
        StressCase("two-lobes-sun", group, "the sun through two lobes", "share of the forward lobe", "", {0, 0.5, 1},
                   Claim::physical, excuses, lobes_of_sun, usual),
        StressCase("spike-lamp", group, "a lamp through a table whose spike gets narrow", "spike", "degrees",
                   {40, 10, 2}, Claim::physical, excuses, spike_of_lamp, usual),
        StressCase("spike-sun", group, "the sun through a table whose spike gets narrow", "spike", "degrees",
                   {40, 10, 2}, Claim::physical, excuses, spike_of_sun, usual),
        StressCase("droplets-shaft", group, "droplets of growing size in a shaft", "diameter", "micrometers",
                   {5, 15, 50}, Claim::physical, excuses, droplets_in_shaft, usual),
    };
}
}
