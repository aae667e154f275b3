// Checks against closed forms and published single-scattering values.
#include "base/text.h"
#include "measure/verify/rays.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include "scene/light.h"
#include "trace/snapshot.h"
#include "volume/tracking.h"

namespace tyndall {
namespace {
const Box unit_box{vec3(0), vec3(1)};
const Box slab{vec3(-1e4f, 0, -1e4f), vec3(1e4f, 1, 1e4f)};

void check_phase(Checks& checks) {
    double worst = 0;
    for (int i = -33; i <= 33; ++i) {
        const Phase phase = forward_phase(static_cast<float>(i) * 0.03f);
        const double total = integral(
            [&](double angle) {
                return 2 * M_PI * std::sin(angle) * phase_value(phase, static_cast<float>(std::cos(angle)));
            },
            0, pi);
        if (std::abs(total - 1) > std::abs(worst)) worst = total - 1;
    }
    checks.add("Henyey-Greenstein integrates to 1, worst of 67 g", 1 + worst, 1, 1e-3, "1e-3");
    const struct {
        float g, cosine;
        double value;
    } rows[] = {{0.5f, 1, 0.4774648}, {0.75f, 0, 0.0178254}, {0.85f, 1, 6.5430365}, {0.85f, -1, 0.0034877}};
    for (const auto& row : rows)
        checks.add("Henyey-Greenstein g " + std::to_string(row.g).substr(0, 4) + " at cosine " +
                       std::to_string(static_cast<int>(row.cosine)),
                   phase_value(forward_phase(row.g), row.cosine), row.value, 2e-5 * row.value, "rounding");
}

// Lobes and tables: their integrals over the sphere and their mean cosines.
void check_phase_shapes(Checks& checks) {
    const auto moment = [](const Phase& phase, int power) { // cosine = 1 - 2 u⁴ resolves narrow lobes
        return integral(
            [&](double u) {
                const double cosine = 1 - 2 * u * u * u * u;
                return 16 * M_PI * u * u * u * std::pow(cosine, power) * phase_value_of<double>(phase, cosine);
            },
            0, 1);
    };
    for (const double diameter : {0.05, 1.0, 3.0, 5.0, 10.0, 20.0, 50.0}) {
        const std::string name = "droplets of " + shortest_text(diameter) + " micrometers";
        checks.add(name + " integrate to 1", moment(mie_phase(diameter), 0), 1, 1e-6, "1e-6");
        checks.add(name + ", mean cosine", moment(mie_phase(diameter), 1), mean_cosine(mie_phase(diameter)), 1e-6,
                   "1e-6");
    }
    const Phase dust = draine_phase(0.7, 1); // Cornette & Shanks 1992: 3 g (4 + g²) / (5 (2 + g²))
    checks.add("Draine g 0.7, alpha 1 integrates to 1", moment(dust, 0), 1, 1e-6, "1e-6");
    checks.add("Draine g 0.7, alpha 1, mean cosine", moment(dust, 1), 2.1 * 4.49 / (5 * 2.49), 1e-6, "1e-6");
    std::vector<double> series;
    for (int l = 0; l < 100; ++l) series.push_back((2 * l + 1) * std::pow(0.6, l));
    PhaseTableNotes notes;
    const Phase table = table_phase(PhaseKind::legendre, make_table(std::span(std::as_const(series)), notes));
    checks.add("a Legendre series of g 0.6 integrates to 1", moment(table, 0), 1, 1e-5, "its kinks");
    checks.add("a Legendre series of g 0.6 at cosine 0.5", phase_value(table, 0.5f),
               phase_value(forward_phase(0.6f), 0.5f), 2e-4, "its steps");
}

void check_transmittance(Checks& checks) {
    for (const float depth : {0.1f, 1.0f, 5.0f, 20.0f}) {
        const Scatter result =
            reference_light(snapshot_of({homogeneous_medium(depth, unit_box)}, {}), {{0.5f, 0.5f, 3}, {0, 0, -1}, 9});
        const double expected = std::exp(-static_cast<double>(depth));
        checks.add("Beer-Lambert, depth " + std::to_string(depth).substr(0, 4), result.transmittance, expected,
                   2e-5 * expected, "rounding");
    }
    Medium height = homogeneous_medium(0.1f, everywhere());
    height.density.kind = DensityKind::height, height.density.height_falloff = 10;
    const Ray ray{{0, 0, 0}, {std::sqrt(0.75f), 0.5f, 0}, 40};
    checks.add("optical depth of height fog", optical_depth(height, ray), 1.729329434, 1e-6, "rounding");

    const Medium grid = noise_medium(3);
    const Ray through{{-1, 0.3f, 0.2f}, glm::normalize(vec3(1, 0.2f, 0.3f)), 3};
    const double sum =
        integral([&](double t) { return 3.0 * density_at(grid, through.at(static_cast<float>(t))); }, 0, 3);
    checks.add("optical depth of a rough grid, against a fine sum", optical_depth(grid, through), sum, 1e-3 * sum,
               "kinks of the sum");
    double mean = 0, squares = 0;
    constexpr uint32_t count = 200000;
    for (uint32_t i = 0; i < count; ++i) {
        RandomStream random{hash(i, 3u)};
        int lookups = 0;
        const double share = ratio_transmittance(grid, through, {0, 3}, random, lookups);
        mean += share / count, squares += share * share / count;
    }
    checks.add("the same by ratio tracking", mean, std::exp(-optical_depth(grid, through)),
               3 * std::sqrt((squares - mean * mean) / count), "3 standard errors");
}

void check_emission(Checks& checks) {
    Medium fire = homogeneous_medium(0.5f, {vec3(-1.5f), vec3(1.5f)}, forward_phase(0), vec3(0));
    fire.optics.emission.radiance = vec3(1);
    const Snapshot snapshot = snapshot_of({fire}, {});
    const Ray ray{{0, 0, 5}, {0, 0, -1}, 20};
    const double expected = 1.553739680; // j/σ (1 - e^(-σs))
    checks.add("glowing fog, march", reference_light(snapshot, ray).radiance.x, expected, 2e-5 * expected, "rounding");
    const RayEstimate light = path_light(snapshot, ray, 4096);
    checks.add("glowing fog, path", light.value.x, expected, 3 * light.error.x, "3 standard errors");
}

// Isotropic single scattering of a slab (Chandrasekhar 1960), times μ0·E/π: reflected w/4 · (1 − e^(−τ/μ−τ/μ0)) /
// (μ + μ0), transmitted w/4 · (e^(−τ/μ) − e^(−τ/μ0)) / (μ − μ0).
void check_slab(Checks& checks) {
    const struct {
        const char* name;
        float albedo, depth, mu;
        bool below;
        double factor;
    } rows[] = {{"reflects, albedo .5, depth 1", 0.5f, 1, 1, false, 0.054041545},
                {"reflects, albedo .9, depth 2, seen at 60°", 0.9f, 2, 0.5f, false, 0.149628187},
                {"transmits, albedo .9, depth 2, seen at 60°", 0.9f, 2, 0.5f, true, 0.052658840}};
    for (const auto& row : rows) {
        const Snapshot snapshot = snapshot_of({homogeneous_medium(row.depth, slab, forward_phase(0), vec3(row.albedo))},
                                              {sun_light({0, -1, 0}, pi)});
        const vec3 direction(0, row.below ? row.mu : -row.mu, std::sqrt(1 - row.mu * row.mu));
        const Ray ray{vec3(0, row.below ? -2 : 3, 0), glm::normalize(direction), 100};
        checks.add(std::string("a slab ") + row.name + ", march", reference_light(snapshot, ray).radiance.x, row.factor,
                   1e-4 * row.factor, "1e-4");
        const RayEstimate light = path_light(snapshot, ray, 1024, 1);
        checks.add(std::string("a slab ") + row.name + ", path", light.value.x, row.factor, 3 * light.error.x,
                   "3 standard errors");
    }
}

void check_airlight(Checks& checks) {
    const struct {
        float extinction, height, before;
        double value;
    } rows[] = {
        {1, 1, 1, 0.01745864}, {0.1f, 1, 5, 0.01151431}, {0.5f, 0.1f, 2, 0.40195407}, {2, 0.5f, 0.5f, 0.06983456}};
    for (const auto& row : rows) {
        const Snapshot snapshot = snapshot_of({homogeneous_medium(row.extinction, everywhere())},
                                              {point_light({0, row.height, -row.before}, 1)});
        const std::string name = "airlight, extinction " + std::to_string(row.extinction).substr(0, 3);
        const Ray ray{{0, 0, 0}, {0, 0, -1}, row.before + 60 / row.extinction};
        checks.add(name + ", march", reference_light(snapshot, ray).radiance.x, row.value, 1e-4 * row.value, "1e-4");
        const RayEstimate light = path_light(snapshot, ray, 2048, 1);
        checks.add(name + ", path", light.value.x, row.value, 3 * light.error.x, "3 standard errors");
    }
}
}

std::vector<CheckGroup> closed_form_checks() {
    return {{"phase functions", 1, check_phase},       {"lobes and tables", 1, check_phase_shapes},
            {"transmittance", 1, check_transmittance}, {"emission", 1, check_emission},
            {"single scattering, sun", 2, check_slab}, {"single scattering, point light", 2, check_airlight}};
}
}
