// Intervals of a ray over which the fog's majorant does not change: what steps are placed in. Internal to
// append_steps(); find_fog() shares the horizon.
#pragma once
#include "volume/rays/steps.h"

#include <vector>

namespace tyndall {
struct Span {
    double low = 0, high = 0; // metres along the ray
    double extinction = 0;    // no point of the span exceeds it, 1/m
    double rate = 0;          // steps per metre for other reasons, at least
    bool apart = false;       // steps end where it begins and ends
};

inline constexpr double opaque_depth = 64; // transmittance 2e-28

// Where fog in closed form alone is opaque, or where the ray ends.
double horizon(const Ray& ray, std::span<const Medium> media);

// Appends the spans of one medium on 0..t_end, ascending and disjoint.
void append_spans(const Ray& ray, const Medium& medium, double t_end, const StepRule& rule, std::vector<Span>& spans);

// Appends stretches around a local light, each with the rate its distance asks for, where steps of that are shorter
// than `longest`. Distances below `closest` count as that.
void append_near_spans(const Ray& ray, vec3 point, double closest, double ratio, double longest,
                       std::vector<Span>& spans);

// Where both lists have a span extinctions add and the larger rate holds. Without `keep_second`, stretches only the
// second list has are left out.
void overlay(const std::vector<Span>& first, const std::vector<Span>& second, bool keep_second,
             std::vector<Span>& result);
}
