// Phase functions of lobes and tables in every mode: against quadrature of the light equation, against each other, and
// in a furnace.
#include "base/gauss_legendre.h"
#include "modes/froxel/limitations.h"
#include "modes/mode.h"
#include "modes/path/path_rays.h"
#include "modes/settings.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/fluence/fluence.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"
#include "volume/phase/mie.h"
#include "volume/phase/phase_samples.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box unit_box{vec3(0), vec3(1)};

std::vector<NamedPhase> some_phases() {
    return {{"draine", draine_phase(0.6, 3)},
            {"droplets of 6", mie_phase(6)},
            {"droplets of 20", mie_phase(20)},
            {"droplets of 50", mie_phase(50)},
            {"mix", mixed_phase(0.6, {PhaseKind::henyey_greenstein, 0.95f}, {PhaseKind::henyey_greenstein, -0.9f})},
            {"table", tabulated_bow(0.9)}};
}

std::vector<NamedPhase> peaked_phases() {
    return {{"halo of ice crystals",
             tabulated(
                 {{0, 3}, {21, 0.5}, {22, 30}, {23, 0.3}, {90, 0.05}, {137, 0.05}, {138, 3}, {139, 0.1}, {180, 0.1}})},
            {"light to the side", tabulated({{0, 0.1}, {89, 0.1}, {90, 5}, {91, 0.1}, {180, 0.1}})}};
}

// A ray from the eye that passes a lamp of 1 cd at a distance h, `before` meters behind the eye, and goes on for as
// long, in fog of extinction s that is everywhere.
double lamp_light(const Phase& phase, double s, double h, double before) {
    const auto part = [&](double v) { // u = h sinh v
        const double u = h * std::sinh(v), r = h * std::cosh(v);
        return s * phase_value_of<double>(phase, -u / r) / r * std::exp(-s * (before + u + r));
    };
    const double end = std::asinh(before / h);
    return integral(part, -end, end, 20000);
}

// Rays at a lamp 4 m away, past it by slopes from a thousandth on.
struct LampRays {
    View view = view_of({0, 0, 4}, {0, 0, 0}, {128, 96}, 0.9f);
    std::vector<Ray> rays;
    std::vector<double> h, before;

    LampRays() {
        for (const float x : {0.004f, 0.02f, 0.06f, 0.15f, 0.3f, 0.5f, 0.9f, 1.4f}) {
            const vec3 direction = glm::normalize(vec3(x, 0, -4));
            const double along = glm::dot(dvec3(direction), dvec3(0, 0, -4));
            h.push_back(glm::length(glm::cross(dvec3(direction), dvec3(0, 0, -4)))), before.push_back(along);
            rays.push_back({view.camera.position, direction, static_cast<float>(2 * along)});
        }
    }
};

// What a rounded cosine leaves of a narrow lobe, as a share: floats tell 1 - c to 1e-7, or to a hundredth of a degree.
double rounding_of(const Phase& phase, double angle) {
    const double gap = 1 - double(narrowest_g(phase));
    return 1.5 * 2e-7 / (gap * gap + angle * angle);
}

TEST(PhaseKinds, LampsInFogOfClosedFormAreTheIntegral) {
    constexpr float s = 0.2f;
    const struct {
        const char* mode;
        double allowed; // share
    } rows[] = {{"march", 3e-3}, {"shadow-volume", 3e-3}, {"cone", 2e-3}, {"froxel", 0.01}, {"shadow-map", 0.12}};
    const LampRays lamp;
    std::vector<NamedPhase> phases = some_phases();
    const size_t even = phases.size(); // the steps of shadow-map are too long for what follows, as it says
    std::ranges::copy(peaked_phases(), std::back_inserter(phases));
    for (size_t p = 0; p < phases.size(); ++p) {
        const NamedPhase& one = phases[p];
        const Snapshot snapshot =
            snapshot_of({homogeneous_medium(s, everywhere(), one.phase)}, {point_light(vec3(0), 1)});
        const auto expect_integral = [&](const std::vector<Scatter>& seen, const char* mode, double allowed) {
            for (size_t i = 0; i < lamp.rays.size(); ++i)
                EXPECT_NEAR(seen[i].radiance.x / lamp_light(one.phase, s, lamp.h[i], lamp.before[i]), 1,
                            allowed + rounding_of(one.phase, lamp.h[i] / lamp.before[i]))
                    << mode << ", " << one.name << ", ray " << i;
        };
        for (const auto& row : rows) {
            if (p >= even && std::string_view(row.mode) == "shadow-map") continue;
            Settings settings = settings_for(Quality::final);
            settings.terms.light = LightTransmittance::marched;
            expect_integral(run_mode(row.mode, lamp.view, snapshot, settings, lamp.rays), row.mode, row.allowed);
        }
        expect_integral(marched(snapshot, exact_settings(), lamp.rays), "exact", 5e-4);
    }
}

// Σ p E (1 - e^-2sl) / 2 on a ray straight at a sun's direction and beside it; light and ray leave the same slab.
TEST(PhaseKinds, SunsAreTheClosedForm) {
    constexpr float s = 0.4f;
    const Box slab{vec3(-1e4f, -1e4f, 0), vec3(1e4f, 1e4f, 1)};
    const View view = view_of({0, 0, 3}, {0, 0, 0}, {64, 48}, 0.9f);
    std::vector<Ray> rays;
    for (const float x : {0.0f, 0.002f, 0.02f, 0.1f, 0.4f})
        rays.push_back({{0, 0, 3}, glm::normalize(vec3(x, 0, -1)), 100});
    for (const NamedPhase& one : some_phases()) {
        // The sun shines along +z: what comes from below has crossed z, the eye sees it through 1 - z.
        const Snapshot snapshot = snapshot_of({homogeneous_medium(s, slab, one.phase)}, {sun_light({0, 0, 1}, 5)});
        for (const char* mode : {"march", "shadow-volume", "cone", "shadow-map"}) {
            Settings settings = settings_for(Quality::final);
            settings.terms.light = LightTransmittance::marched;
            const auto seen = run_mode(mode, view, snapshot, settings, rays);
            for (size_t i = 0; i < rays.size(); ++i) {
                const double mu = -double(rays[i].direction.z), k = double(s) * (1 / mu - 1);
                const double along = k > 1e-9 ? -std::expm1(-k) / k : 1; // ∫ e^{-s (z + (1-z)/mu)} dz / e^-s
                const double expected =
                    5 * double(s) * phase_value_of<double>(one.phase, mu) * std::exp(-double(s)) * along / mu;
                EXPECT_NEAR(seen[i].radiance.x / expected, 1, 0.003 + rounding_of(one.phase, std::acos(mu)))
                    << mode << ", " << one.name << ", ray " << i;
            }
        }
    }
}

// Seen from inside the fog, straight at the sun: what is bright for a third of a degree fills a froxel of a degree.
TEST(PhaseKinds, FroxelsSayThatTheyBlurTheGlowOfASun) {
    const Box box{vec3(-4), vec3(4)};
    const View view = view_of({0, 0, 3}, {0, 0, 0}, {320, 180}, 0.8f),
               beside = view_of({0, 0, 3}, {3, 0, 3}, {320, 180}, 0.8f);
    const auto said = [&](const Phase& phase, const View& seen) {
        const Snapshot snapshot =
            snapshot_of({homogeneous_medium(0.1f, box, phase)}, {sun_light({0.01f, 0.02f, 1}, 5)});
        return froxel_limitations(seen, snapshot, settings_for(Quality::preview));
    };
    EXPECT_TRUE(has_limitation(said(mie_phase(20), view), limitation::coarse_glow));
    EXPECT_FALSE(has_limitation(said(mie_phase(20), beside), limitation::coarse_glow)) << "the sun is not in the image";
    EXPECT_FALSE(has_limitation(said(forward_phase(0.8f), view), limitation::coarse_glow));
    EXPECT_TRUE(has_limitation(said(peaked_phases()[0].phase, beside), limitation::coarse_glow)) << "a halo";
    EXPECT_FALSE(has_limitation(said(legendre_of(0.5, 20), beside), limitation::coarse_glow));
    for (const Limitation& one : said(peaked_phases()[0].phase, beside))
        if (one.is(limitation::coarse_glow)) {
            EXPECT_NEAR(one.amounts[0], 1, 0.1);
        }
    for (const Limitation& one : said(mie_phase(20), view))
        if (one.is(limitation::coarse_glow)) {
            EXPECT_NEAR(one.amounts[0], 0.77 * 0.00539 * 180 / std::numbers::pi, 0.01);
        }
}

TEST(PhaseKinds, OneOrderOfPathIsTheMarch) {
    // A rough grid and even fog around it, a lamp beside it: several media whose phase functions mix.
    const Medium grid = medium_of(unit_volume(16, [](vec3 p) { return p.x * p.y + 0.2f * p.z; }), 2.5f);
    const View view = view_of({0.5f, 0.8f, 3}, {0.5f, 0.5f, 0.5f}, {8, 6}, 0.5f);
    for (const NamedPhase& one : some_phases()) {
        Medium cloud = grid;
        cloud.optics.phase = one.phase;
        const Snapshot snapshot =
            snapshot_of({cloud, homogeneous_medium(0.3f, {vec3(-1), vec3(2)}, forward_phase(0.3f))},
                        {point_light({0.3f, 0.6f, -1.5f}, 4), sun_light({0.2f, -1, 0.5f}, 2)});
        const std::vector<Ray> rays = pixel_rays(view, snapshot, 10);
        const auto exact = marched(snapshot, exact_settings(), rays);
        double traced_sum = 0, exact_sum = 0, variance = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const RayEstimate estimate = traced(snapshot, rays[i], 64, 1);
            traced_sum += estimate.value.x, exact_sum += double(exact[i].radiance.x);
            variance += estimate.error.x * estimate.error.x;
        }
        EXPECT_NEAR(traced_sum, exact_sum, 4 * std::sqrt(variance) + 2e-3 * exact_sum) << one.name;
        EXPECT_LT(std::sqrt(variance), 0.02 * exact_sum) << one.name << ": enough samples to tell";
    }
}

TEST(PhaseKinds, PathKeepsAllLightInAFurnace) {
    const Medium grid = medium_of(unit_volume(16, [](vec3 p) { return p.x * p.y + 0.2f; }), 6);
    for (const NamedPhase& one : some_phases()) {
        Medium cloud = grid;
        cloud.optics.phase = one.phase, cloud.optics.albedo = vec3(1);
        Snapshot snapshot = snapshot_of({cloud, homogeneous_medium(0.5f, {vec3(-1), vec3(2)}, one.phase)}, {}, vec3(1));
        snapshot.background.color = vec3(1);
        const RayEstimate estimate = traced(snapshot, {{0.4f, 0.45f, 3}, {0, 0, -1}}, 2048);
        EXPECT_NEAR(estimate.value.x, 1, 0.005) << one.name;
        EXPECT_LT(std::abs(estimate.value.x - 1), 4 * estimate.error.x + 1e-4) << one.name;
    }
}

TEST(PhaseKinds, FluenceTurnsABeamLobeByLobe) {
    // A beam along +z, as narrow as fluence knows it, is spread as the fog says; by lobes that is exact for
    // Henyey-Greenstein's.
    FluenceAt beam;
    beam.fluence = vec3(2);
    for (int c = 0; c < 3; ++c) beam.flux[c] = vec3(0, 0, 2);
    const Phase mixed = mixed_phase(0.7, {PhaseKind::henyey_greenstein, 0.9f}, {PhaseKind::henyey_greenstein, -0.4f});
    for (const float c : {-1.0f, -0.3f, 0.5f, 0.95f}) {
        // The eye looks along -direction of what it sees.
        const vec3 towards_eye(std::sqrt(1 - c * c), 0, c);
        EXPECT_NEAR(scattered_fluence(beam, -towards_eye, mixed).x / (2 * phase_value(mixed, c)), 1, 1e-3) << c;
    }
    for (const NamedPhase& one :
         some_phases()) { // right to the first moment: the sum over all directions, and its mean
        FluenceAt at = beam;
        for (int c = 0; c < 3; ++c) at.flux[c] = vec3(0, 0, 1);
        double sum = 0, cosine = 0;
        constexpr int pieces = 20000;
        for (int i = 0; i < pieces; ++i) {
            const double mu = -1 + 2 * (i + 0.5) / pieces;
            const vec3 towards_eye(static_cast<float>(std::sqrt(1 - mu * mu)), 0, static_cast<float>(mu));
            const double value = 4 * std::numbers::pi / pieces * scattered_fluence(at, -towards_eye, one.phase).x;
            sum += value, cosine += mu * value;
        }
        EXPECT_NEAR(sum, 2, 2e-3) << one.name;
        EXPECT_NEAR(cosine / 2, 0.5 * mean_cosine(one.phase), 2e-3) << one.name;
    }
}

// Droplets send half of the light on by less than a degree: fog without that half is the same but for its glow. Paths
// cannot tell it from the light of a sun, which they find by chance only.
TEST(PhaseKinds, ManyOrdersOfTheMarchAreThoseOfPath) {
    const View view = view_of({0.5f, 0.5f, 3}, {0.5f, 0.5f, 0.5f}, {4, 3}, 0.35f);
    const MieFit fit = mie_fit(20);
    const float rest = static_cast<float>(fit.draine_weight);
    const struct {
        const char* name;
        Phase phase, traced;
        float extinction, traced_extinction;
        double allowed;
    } cases[] = {
        {"table", tabulated_bow(0.7), tabulated_bow(0.7), 3, 3, 0.04},
        {"draine", draine_phase(0.594, 27), draine_phase(0.594, 27), 2, 2, 0.1},
        {"mix", mixed_phase(0.7, forward_phase(0.8f), forward_phase(-0.5f)),
         mixed_phase(0.7, forward_phase(0.8f), forward_phase(-0.5f)), 3, 3, 0.15},
        {"droplets", mie_phase(20), draine_phase(fit.draine_g, fit.draine_alpha), 4, 4 * rest, 0.1},
    };
    for (const auto& one : cases) {
        const auto fog = [&](float extinction, const Phase& phase) {
            return snapshot_of({homogeneous_medium(extinction, unit_box, phase)}, {sun_light({0.6f, -1, -0.3f}, 5)});
        };
        Settings settings = settings_for(Quality::final);
        settings.fluence.orders = all_orders, settings.fluence.paths = 1 << 19, settings.fluence.resolution = 16;
        const Snapshot snapshot = fog(one.extinction, one.phase);
        const std::vector<Ray> rays = pixel_rays(view, snapshot, 10);
        const auto seen = marched(snapshot, settings, rays);
        Settings exact = exact_settings();
        exact.fluence = settings.fluence;
        EXPECT_LT(relative_rmse(marched(snapshot, exact, rays), seen), 0.02) << one.name << ": kernels and plain code";
        double march = 0, path = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            march += double(seen[i].radiance.x);
            path += traced(fog(one.traced_extinction, one.traced), rays[i], 256).value.x;
        }
        EXPECT_NEAR(march / path, 1, one.allowed) << one.name;
    }
}
}
}
