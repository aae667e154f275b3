#include "scene/lights/spherical_rectangle.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
SphericalRectangle::SphericalRectangle(dvec3 center, dvec3 right, dvec3 up, glm::dvec2 half, dvec3 point) {
    const dvec3 offset = center - point;
    const glm::dvec2 middle(glm::dot(offset, right), glm::dot(offset, up));
    low = middle - half, high = middle + half;
    height = -std::abs(glm::dot(offset, glm::cross(right, up)));
    if (height == 0) return;

    // Normals of the planes through the point and each side, and the angles between adjacent planes.
    const dvec3 corners[] = {
        {low.x, low.y, height}, {high.x, low.y, height}, {high.x, high.y, height}, {low.x, high.y, height}};
    dvec3 normals[4];
    for (int i = 0; i < 4; ++i) normals[i] = glm::normalize(glm::cross(corners[i], corners[(i + 1) % 4]));
    double angles[4];
    for (int i = 0; i < 4; ++i)
        angles[i] = std::acos(std::clamp(-glm::dot(normals[i], normals[(i + 1) % 4]), -1.0, 1.0));
    first = normals[0].z, opposite = normals[2].z;
    rest = 2 * std::numbers::pi - angles[2] - angles[3];
    steradians = std::max(angles[0] + angles[1] - rest, 0.0);
}

glm::dvec2 SphericalRectangle::place(glm::dvec2 u) const {
    const double angle = u.x * steradians + rest;
    const double slope = (std::cos(angle) * first - opposite) / std::sin(angle);
    const double cosine = std::clamp(std::copysign(1 / std::hypot(slope, first), slope), -1.0, 1.0);
    const double x = std::clamp(-cosine * height / std::max(std::sqrt(1 - cosine * cosine), 1e-12), low.x, high.x);
    const double away = std::hypot(x, height);
    const double from = low.y / std::hypot(away, low.y), to = high.y / std::hypot(away, high.y);
    const double share = from + u.y * (to - from), left = 1 - share * share;
    const double y = left > 1e-12 ? std::clamp(share * away / std::sqrt(left), low.y, high.y) : high.y;
    return {x - 0.5 * (low.x + high.x), y - 0.5 * (low.y + high.y)};
}
}
