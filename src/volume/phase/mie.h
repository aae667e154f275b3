// Mie scattering of water droplets in fog and clouds as a Henyey-Greenstein and a Draine lobe: the fit of Jendersie and
// d'Eon 2023, "An approximate Mie scattering function for fog and cloud rendering", equations 4 to 20.
#pragma once
namespace tyndall {
struct MieFit {
    double g = 0;                          // of the Henyey-Greenstein lobe, which has the remaining weight
    double draine_g = 0, draine_alpha = 0; // of the Draine lobe
    double draine_weight = 0;              // weight of the Draine lobe
};

inline constexpr double largest_droplet = 50; // micrometers; upper limit of the fit

// Diameter in micrometers, above 0 and up to 50. The fit for 5 to 50 covers fog and clouds; three more below cover haze
// and smoke. The fits do not join exactly at 0.1, 1.5 and 5.
MieFit mie_fit(double diameter);
}
