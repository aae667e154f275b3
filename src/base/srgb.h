// The transfer function of sRGB (IEC 61966-2-1), for values in [0,1].
#pragma once
#include <cmath>

namespace tyndall {
template<typename Real> Real srgb_encoded(Real linear) {
    return linear <= Real(0.0031308) ? Real(12.92) * linear
                                     : Real(1.055) * std::pow(linear, 1 / Real(2.4)) - Real(0.055);
}

template<typename Real> Real srgb_decoded(Real code) {
    return code <= Real(0.04045) ? code / Real(12.92) : std::pow((code + Real(0.055)) / Real(1.055), Real(2.4));
}
}
