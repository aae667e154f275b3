// A rectangle as a point sees it, and places on it that are even over its solid angle: Ureña, Fajardo and King, "An
// area-preserving parametrization for spherical rectangles", 2013.
#pragma once
#include "base/math.h"

namespace tyndall {
struct SphericalRectangle {
    // Unit axes along its sides, half their lengths in metres.
    SphericalRectangle(dvec3 center, dvec3 right, dvec3 up, glm::dvec2 half, dvec3 point);

    // Metres from the middle along the two axes.
    glm::dvec2 place(glm::dvec2 u) const;

    double steradians = 0; // 0 in its plane
private:
    glm::dvec2 low{0}, high{0};     // the sides as the point sees them: from where it stands before the plane
    double height = 0;              // of the plane, at most 0
    double first = 0, opposite = 0; // the ordinates of the normals of the sides along `right`
    double rest = 0;
};
}
