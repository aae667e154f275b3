// Places along a ray that are even in the angle seen from a local light: there 1/r² is constant (Kulla & Fajardo 2012,
// section 4.1).
#pragma once
#include <cmath>

namespace tyndall {
// A stretch of a ray by its angles: t = nearest + height · tan θ.
template<class T> struct EquiAngular {
    T nearest{}, height{}; // t where the ray passes the light, and how far off
    T from{}, to{};        // θ of the stretch's ends

    struct Place {
        T t, length; // length: dt/dshare, what a unit of the share stands for
    };
    Place at(T share) const { // share of the angle that lies before, 0..1
        const T slope = std::tan(from + share * (to - from));
        return {nearest + height * slope, (to - from) * height * (1 + slope * slope)};
    }
    T density(T t) const { // of places that are even in the share, 1/m
        const T off = t - nearest;
        return height / ((to - from) * (height * height + off * off));
    }
};

template<class T> EquiAngular<T> equi_angular(T nearest, T height, T low, T high) {
    return {nearest, height, std::atan((low - nearest) / height), std::atan((high - nearest) / height)};
}
}
