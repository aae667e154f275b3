// Phase functions of each kind, and integrals over them.
#pragma once
#include "base/gauss_legendre.h"
#include "volume/phase.h"
#include "volume/phase/table.h"

#include <string>
#include <vector>

namespace tyndall::test {
struct NamedPhase {
    std::string name;
    Phase phase;
};

inline Phase tabulated(const std::vector<PhaseEntry>& entries) {
    PhaseTableNotes notes;
    return table_phase(PhaseKind::table, make_table(std::span<const PhaseEntry>(entries), notes));
}

// A table of Henyey and Greenstein's form, with a bow at 138 degrees.
inline Phase tabulated_bow(double g) {
    std::vector<PhaseEntry> entries;
    for (int i = 0; i <= 720; ++i) {
        const double angle = i / 4.0, c = std::cos(angle * std::numbers::pi / 180);
        const double bow = 0.3 * std::exp(-std::pow((angle - 138) / 1.5, 2));
        entries.push_back({angle, (1 - g * g) / std::pow(1 + g * g - 2 * g * c, 1.5) + bow});
    }
    return tabulated(entries);
}

inline Phase legendre_of(double g, int degree) {
    std::vector<double> coefficients;
    for (int l = 0; l <= degree; ++l) coefficients.push_back((2 * l + 1) * std::pow(g, l));
    PhaseTableNotes notes;
    return table_phase(PhaseKind::legendre, make_table(std::span<const double>(coefficients), notes));
}

inline std::vector<NamedPhase> shaped_phases() {
    std::vector<NamedPhase> phases;
    for (const double g : {-0.99, -0.6, -1e-3, 0.0, 1e-4, 4.9e-3, 5.1e-3, 0.05, 0.5, 0.9, 0.99})
        for (const double alpha : {0.0, 0.3, 1.0, 25.0, 250.0, 1e6})
            phases.push_back({"draine " + std::to_string(g) + " " + std::to_string(alpha), draine_phase(g, alpha)});
    for (const double d : {0.01, 0.05, 0.1, 0.11, 0.5, 1.0, 1.4999, 1.5, 3.0, 4.8, 4.9999, 5.0, 10.0, 20.0, 35.0, 50.0})
        phases.push_back({"mie " + std::to_string(d), mie_phase(d)});
    const Phase forward{PhaseKind::henyey_greenstein, 0.8f}, back{PhaseKind::henyey_greenstein, -0.5f};
    for (const double share : {0.0, 0.3, 1.0}) phases.push_back({"mix", mixed_phase(share, forward, back)});
    phases.push_back({"mix of even ones", mixed_phase(0.4, {PhaseKind::isotropic}, {PhaseKind::rayleigh})});
    phases.push_back({"mix of droplets", mixed_phase(0.4, mie_phase(8), mie_phase(30))});
    phases.push_back({"table", tabulated_bow(0.85)});
    phases.push_back({"legendre", legendre_of(0.8, 200)});
    return phases;
}

// ∫ f(c) 2π dc from -1 to 1, fine towards both ends.
template<class Value> double over_sphere(const Value& f) {
    const auto part = [&](double u) { // c = ±(1 - u⁴)
        const double u3 = u * u * u, c = 1 - u3 * u;
        return 2 * std::numbers::pi * 4 * u3 * (f(c) + f(-c));
    };
    return integral(part, 0, 1, 4000);
}
}
