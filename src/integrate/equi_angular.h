// Equi-angular sampling along a ray: uniform in the angle seen from a local light, which cancels 1/r² (Kulla & Fajardo
// 2012, section 4.1).
#pragma once
#include <cmath>

namespace tyndall {
// A ray segment parameterized by angle: t = nearest + height · tan θ.
template<class T> struct EquiAngular {
    T nearest{}, height{}; // t of the point closest to the light, and its distance from the light
    T from{}, to{};        // θ at the ends of the segment

    struct Sample {
        T t, length; // length: dt/dshare
    };
    Sample at(T share) const { // share: fraction of the angle range, 0..1
        const T slope = std::tan(from + share * (to - from));
        return {nearest + height * slope, (to - from) * height * (1 + slope * slope)};
    }
    T pdf(T t) const { // of t, for uniform shares, 1/m
        const T off = t - nearest;
        return height / ((to - from) * (height * height + off * off));
    }
};

template<class T> EquiAngular<T> equi_angular(T nearest, T height, T low, T high) {
    return {nearest, height, std::atan((low - nearest) / height), std::atan((high - nearest) / height)};
}
}
