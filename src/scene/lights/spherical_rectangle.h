// Uniform sampling of the solid angle that a rectangle subtends at a point: Ureña, Fajardo and King, "An
// area-preserving parametrization for spherical rectangles", 2013.
#pragma once
#include "base/math.h"

namespace tyndall {
struct SphericalRectangle {
    // Unit axes along the sides; half lengths in meters.
    SphericalRectangle(dvec3 center, dvec3 right, dvec3 up, glm::dvec2 half, dvec3 point);

    // The sampled point for u in [0,1)²: meters from the center along the two axes.
    glm::dvec2 place(glm::dvec2 u) const;

    double steradians = 0; // 0 for a point in the rectangle's plane
private:
    glm::dvec2 low{0}, high{0};     // the sides, relative to the point's projection onto the plane
    double height = 0;              // of the plane relative to the point, at most 0
    double first = 0, opposite = 0; // z components of the normals of the sides along `right`
    double rest = 0;
};
}
