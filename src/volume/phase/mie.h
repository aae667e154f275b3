// Water droplets of fog and clouds as two lobes, Henyey and Greenstein's and Draine's: the fit of Jendersie and d'Eon
// 2023, "An approximate Mie scattering function for fog and cloud rendering", equations 4 to 20.
#pragma once
namespace tyndall {
struct MieFit {
    double g = 0;                          // of the Henyey-Greenstein lobe, which holds the rest of the light
    double draine_g = 0, draine_alpha = 0; // of Draine's lobe
    double draine_weight = 0;              // and its share of the light
};

inline constexpr double largest_droplet = 50; // micrometres: the fit ends there

// Diameter in micrometres, above 0 to 50. Fog and clouds are the fit of 5 to 50; below there are three more, of haze
// and smoke, which do not meet exactly at 0.1, 1.5 and 5.
MieFit mie_fit(double diameter);
}
