// Intervals of a ray with a constant majorant, in which steps are placed. Internal to append_steps(), except horizon(),
// which find_fog() shares.
#pragma once
#include "volume/rays/steps.h"

#include <vector>

namespace tyndall {
struct Span {
    double low = 0, high = 0; // meters along the ray
    double extinction = 0;    // majorant, 1/m
    double rate = 0;          // minimum steps per meter for other reasons
    bool apart = false;       // steps must not cross its ends
};

inline constexpr double opaque_depth = 64; // transmittance 2e-28

// Where homogeneous and height fog alone become opaque, or the end of the ray.
double horizon(const Ray& ray, std::span<const Medium> media);

// Appends the spans of one medium on 0..t_end, ascending and disjoint.
void append_spans(const Ray& ray, const Medium& medium, double t_end, const StepRule& rule, std::vector<Span>& spans);

// Appends spans around a local light with steps of `ratio` times the distance to it, where that is shorter than
// `longest`. Distances are clamped to at least `closest`.
void append_near_spans(const Ray& ray, vec3 point, double closest, double ratio, double longest,
                       std::vector<Span>& spans);

// Overlays two lists: where spans overlap, extinctions add and the larger rate applies. Without `keep_second`,
// intervals covered only by the second list are dropped.
void overlay(const std::vector<Span>& first, const std::vector<Span>& second, bool keep_second,
             std::vector<Span>& result);
}
