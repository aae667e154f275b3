#include "volume/phase/mie.h"

#include <cassert>
#include <cmath>

namespace tyndall {
namespace {
MieFit smallest(double d) {
    return {13.8 * d * d, 1.1456 * d * std::sin(9.29044 * d), 250, 0.252977 - 312.983 * std::pow(d, 4.3)};
}

MieFit small(double d) {
    const double l = std::log(d);
    const double inner = std::cos((l - 0.238604) * (l + 1.00667) / (0.507522 - 0.15677 * l));
    return {0.862 - 0.143 * l * l, 0.379685 * std::cos(1.19692 * inner + 1.37932 * l + 0.0625835) + 0.344213, 250,
            0.146209 * std::cos(3.38707 * l + 2.11193) + 0.316072 + 0.0778917 * l};
}

MieFit middle(double d) {
    const double l = std::log(d), ll = std::log(l);
    return {0.0604931 * ll + 0.940256, 0.500411 - 0.081287 / (-2 * l + std::tan(l) + 1.27551), 7.30354 * l + 6.31675,
            0.026914 * (l - std::cos(5.68947 * (ll - 0.0292149))) + 0.376475};
}

MieFit large(double d) {
    return {std::exp(-0.0990567 / (d - 1.67154)), std::exp(-2.20679 / (d + 3.91029) - 0.428934),
            std::exp(3.62489 - 8.29288 / (d + 5.52825)), std::exp(-0.599085 / (d - 0.641583) - 0.665888)};
}
}

MieFit mie_fit(double diameter) {
    assert(diameter > 0 && diameter <= largest_droplet);
    if (diameter >= 5) return large(diameter);
    if (diameter >= 1.5) return middle(diameter);
    return diameter > 0.1 ? small(diameter) : smallest(diameter);
}
}
