#include "modes/froxel/grid.h"

namespace tyndall {
FroxelGrid make_froxel_grid(const Camera& camera, ivec2 image_size, int tile) {
    FroxelGrid grid;
    grid.camera = camera, grid.image_size = image_size, grid.tile = tile;
    grid.size = (image_size + tile - 1) / tile + 2;

    // As in camera_ray(), a pixel's position on the plane at unit depth is linear in the pixel.
    const vec2 extent(image_size);
    const float height = view_height(camera);
    const vec3 x = camera.right * (height / extent.y), y = -camera.up * (height / extent.y);
    const vec3 corner = -0.5f * (extent.x * x + extent.y * y);
    grid.origin = camera.position, grid.step = camera.forward;
    if (camera.ortho_height > 0)
        grid.origin += corner, grid.origin_x = x, grid.origin_y = y;
    else
        grid.step += corner, grid.step_x = x, grid.step_y = y;
    for (int row = 0; row < grid.size.y; ++row)
        for (int column = 0; column < grid.size.x; ++column)
            grid.slants.push_back(glm::length(grid.line_step(grid.pixel_of(vec2(column, row)))));
    return grid;
}

void set_slices(FroxelGrid& grid, float near, float far, int count, float growth, float end, int tail) {
    far = std::max(far, near * 1.0001f); // keeps faces distinct despite rounding
    // Thickness grows by growth^(1/(count-1)) from slice to slice: faces lie at (r^k - 1) / (r^count - 1).
    const double rate = count > 1 ? std::log(static_cast<double>(growth)) / (count - 1) : 0;
    const double whole = std::expm1(rate * count);
    grid.faces.resize(static_cast<size_t>(count) + 1);
    for (int k = 0; k <= count; ++k) {
        const double share = std::abs(rate) < 1e-9 ? static_cast<double>(k) / count : std::expm1(rate * k) / whole;
        grid.faces[static_cast<size_t>(k)] = static_cast<float>(near + share * (far - near));
    }

    const float thinnest = std::min(grid.faces[1] - near, far - grid.faces[static_cast<size_t>(count) - 1]);
    const int stretches = static_cast<int>(std::clamp((far - near) / thinnest, 1.0f, 65536.0f)) + 1;
    grid.stretches_per_meter = static_cast<float>(stretches) / (far - near);
    grid.first_slice.assign(static_cast<size_t>(stretches), 0);
    for (int i = 0, k = 0; i < stretches; ++i) {
        const float start = near + (static_cast<float>(i) - 0.01f) / grid.stretches_per_meter;
        while (k + 1 < count && grid.faces[static_cast<size_t>(k) + 1] <= start) ++k;
        grid.first_slice[static_cast<size_t>(i)] = k;
    }

    if (!(end > far)) return;
    const float first = far - grid.faces[static_cast<size_t>(count) - 1]; // the tail starts as thick as the last slice
    const double ratio = std::log1p(static_cast<double>(end - far) / first) / tail;
    for (int k = 1; k <= tail; ++k) grid.faces.push_back(static_cast<float>(far + first * std::expm1(ratio * k)));
}

vec3 project(const FroxelGrid& grid, vec3 point) {
    const Camera& camera = grid.camera;
    const vec3 offset = point - camera.position;
    const float z = glm::dot(offset, camera.forward);
    const float per_meter = static_cast<float>(grid.image_size.y) / view_height(camera, z);
    const vec2 across(glm::dot(offset, camera.right), -glm::dot(offset, camera.up));
    return vec3(across * per_meter + 0.5f * vec2(grid.image_size), z);
}
}
