// Froxels: the view frustum in tiles of the image times slices of planar depth.
//
//   across   tile (1,1) covers the image's upper left corner; a border of one tile surrounds the image, so that every
//            look-up inside has neighbors on all sides
//   in depth slice k lies between the planar depths faces[k] and faces[k+1]; each slice is thicker than the previous
//   one
//            by the same factor, and fog that extends behind the scene gets a few long slices of its own
#pragma once
#include "scene/camera.h"

#include <cstdint>
#include <vector>

namespace tyndall {
struct FroxelGrid {
    Camera camera;
    ivec2 image_size{0}; // pixels
    int tile = 1;        // pixels per froxel, across and down
    ivec2 size{0};       // tiles, including the border around the image
    std::vector<float> faces;

    // The point at pixel (x, y) and planar depth z: origin + x·origin_x + y·origin_y + z (step + x·step_x + y·step_y).
    vec3 origin{0}, origin_x{0}, origin_y{0}, step{0}, step_x{0}, step_y{0};

    std::vector<float> slants; // per tile: length of the line through its center per meter of planar depth

    std::vector<int32_t> first_slice; // slice at or before the start of each of many equal depth intervals
    float stretches_per_meter = 0;

    float thickness(size_t slice) const { return faces[slice + 1] - faces[slice]; } // in planar depth, meters
    int slices() const { return static_cast<int>(faces.size()) - 1; }
    size_t tiles() const { return static_cast<size_t>(size.x) * static_cast<size_t>(size.y); }
    size_t tile_index(ivec2 at) const {
        return static_cast<size_t>(at.y) * static_cast<size_t>(size.x) + static_cast<size_t>(at.x);
    }
    // Tile coordinates of a pixel; integers are tile centers.
    vec2 tile_of(vec2 pixel) const { return pixel / static_cast<float>(tile) + 0.5f; }
    ivec2 tile_of_pixel(vec2 pixel) const { return glm::clamp(ivec2(tile_of(pixel) + 0.5f), ivec2(0), size - 1); }
    vec2 pixel_of(vec2 place) const { return (place - 0.5f) * static_cast<float>(tile); }
    vec3 line_step(vec2 pixel) const { return step + pixel.x * step_x + pixel.y * step_y; }
    vec3 point(vec2 pixel, float z) const {
        return origin + pixel.x * origin_x + pixel.y * origin_y + z * line_step(pixel);
    }
};

// Width of a froxel at planar depth z, meters.
inline float froxel_width(const FroxelGrid& grid, float z) {
    return static_cast<float>(grid.tile) * (glm::length(grid.origin_x) + z * glm::length(grid.step_x));
}

// Same as camera_ray(), without computing a tangent.
inline Ray line_ray(const FroxelGrid& grid, vec2 pixel) {
    const vec3 step = grid.line_step(pixel);
    const float length = glm::length(step);
    return {grid.point(pixel, 0), step / length, grid.camera.far * length};
}

// The tiles of an image; set_slices() adds the slices.
FroxelGrid make_froxel_grid(const Camera& camera, ivec2 image_size, int tile);

// Sets slices from `near` to `far`, the last one `growth` times as thick as the first, then `tail` increasingly long
// ones up to `end` (no tail if end <= far).
void set_slices(FroxelGrid& grid, float near, float far, int count, float growth, float end, int tail);

// The slice that contains a planar depth, clamped to the first and last.
inline int slice_of(const FroxelGrid& grid, float z) {
    const float place = (z - grid.faces.front()) * grid.stretches_per_meter;
    const int last = static_cast<int>(grid.first_slice.size()) - 1;
    int k = grid.first_slice[place > 0 ? (place < static_cast<float>(last) ? static_cast<int>(place) : last) : 0];
    while (k + 1 < grid.slices() && z >= grid.faces[k + 1]) ++k;
    return k;
}

// Pixel and planar depth of a point. Undefined, with a depth of 0 or less, behind a perspective camera.
vec3 project(const FroxelGrid& grid, vec3 point);
}
