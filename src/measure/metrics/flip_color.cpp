#include "measure/metrics/flip_color.h"

namespace tyndall {
namespace {
// Rows: X, Y, Z divided by those of white, from the primaries of Rec.709 and white at x = 0.31271, y = 0.32902.
const mat3& xyz_matrix() {
    static const mat3 matrix = glm::transpose(mat3(0.43389539f, 0.37624237f, 0.18986224f, //
                                                   0.21263682f, 0.71518298f, 0.07218020f, //
                                                   0.01775242f, 0.10946563f, 0.87278195f));
    return matrix;
}

float lab_curve(float t) {
    constexpr float d = 6.0f / 29;
    return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0f / 29;
}
}

vec3 ycxcz_of_rgb(vec3 rgb) {
    const vec3 xyz = xyz_matrix() * rgb;
    return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

vec3 rgb_of_ycxcz(vec3 ycxcz) {
    static const mat3 inverse = mat3(glm::inverse(glm::dmat3(xyz_matrix())));
    const float y = (ycxcz.x + 16) / 116;
    return inverse * vec3(ycxcz.y / 500 + y, y, y - ycxcz.z / 200);
}

vec3 hunt_lab_of_rgb(vec3 rgb) {
    const vec3 xyz = xyz_matrix() * rgb;
    const vec3 f(lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z));
    const float lightness = 116 * f.y - 16;
    return {lightness, 0.01f * lightness * 500 * (f.x - f.y), 0.01f * lightness * 200 * (f.y - f.z)};
}

float hyab(vec3 a, vec3 b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }
}
