#include "volume/vdb/file/transform.h"

#include "base/text.h"

#include <array>

namespace tyndall {
namespace {
bool is_close(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)); }

// Reads the scale and four vectors derived from it, which the library trusts and uses in its place.
dvec3 read_scales(ByteCursor& file) {
    const auto scale = file.value<dvec3>("the transform");
    const auto derived = file.value<std::array<dvec3, 4>>("the transform");
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(scale[axis]) || scale[axis] == 0) continue; // reported by matrix_problem()
        const double inverse = 1 / scale[axis];
        const bool agrees = is_close(derived[0][axis], std::abs(scale[axis])) && is_close(derived[1][axis], inverse) &&
                            is_close(derived[2][axis], inverse * inverse) && is_close(derived[3][axis], inverse / 2);
        if (!agrees) file.complain("its transform is inconsistent: its scale does not match its voxel size");
    }
    return scale;
}

dmat4 placed(dvec3 scale, dvec3 translation) {
    dmat4 matrix(1);
    for (int axis = 0; axis < 3; ++axis) matrix[axis][axis] = scale[axis];
    matrix[3] = glm::dvec4(translation, 1);
    return matrix;
}

// Sixteen numbers for row vectors times matrix, which is the same memory order as column-major for column vectors.
dmat4 read_matrix(ByteCursor& file) {
    const auto rows = file.value<std::array<double, 16>>("the transform");
    dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = rows[static_cast<size_t>(i)];
    return matrix;
}

// Returns false if the type is not a linear map.
bool read_linear_map(ByteCursor& file, const std::string& type, dmat4& matrix) {
    if (type == "UniformScaleMap" || type == "ScaleMap") {
        matrix = placed(read_scales(file), dvec3(0));
    } else if (type == "UniformScaleTranslateMap" || type == "ScaleTranslateMap") {
        const auto translation = file.value<dvec3>("the transform");
        matrix = placed(read_scales(file), translation);
    } else if (type == "TranslationMap") {
        matrix = placed(dvec3(1), file.value<dvec3>("the transform"));
    } else if (type == "AffineMap" || type == "UnitaryMap") {
        matrix = read_matrix(file);
    } else {
        return false;
    }
    return true;
}
}

std::string matrix_problem(const dmat4& matrix) {
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(matrix[i / 4][i % 4])) return "its transform has a value that is not finite";
    if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1)
        return "its transform is a projection, not an affine map";
    const double determinant = glm::determinant(matrix);
    if (!(std::abs(determinant) >= 1e-30 && std::abs(determinant) <= 1e30))
        return "its transform is singular or out of range (determinant " + formatted("%g", determinant) + ")";

    // Points must survive the round trip to world space and back.
    const dmat4 inverse = glm::inverse(matrix);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 index(corner & 1 ? 1e4 : 0, corner & 2 ? 1e4 : 0, corner & 4 ? 1e4 : 0, 1);
        const glm::dvec4 error = inverse * (matrix * index) - index;
        if (!(glm::dot(error, error) < 1e-6))
            return "its transform is too far from the origin or too flat to be inverted";
    }
    return {};
}

VdbTransform read_transform(ByteCursor& file) {
    VdbTransform result;
    const std::string type = file.text(256, "the name of the transform");
    if (read_linear_map(file, type, result.index_to_world)) {
        result.problem = matrix_problem(result.index_to_world);
    } else if (type == "NonlinearFrustumMap") {
        // Index box, taper and depth, then the linear map that places it.
        file.skip(8 * sizeof(double), "the transform");
        const std::string second = file.text(256, "the name of the transform");
        result.complete = read_linear_map(file, second, result.index_to_world);
        result.problem = "its transform is a camera frustum; resample the grid to a linear transform first";
    } else {
        result.complete = false;
        result.problem = "its transform type is unknown: " + type;
    }
    return result;
}
}
