// Froxels: the view frustum in tiles of the picture times slices of planar depth.
//
//   across   tile (1,1) covers the picture's upper left corner; one more tile lies beyond each edge of the picture, so
//            that every look-up inside it has neighbours on all sides
//   in depth slice k lies between the planar depths faces[k] and faces[k+1]; each slice is thicker than the one before
//            by the same factor, and fog that goes on beyond the scene gets a few long slices of its own
#pragma once
#include "scene/camera.h"

#include <cstdint>
#include <vector>

namespace tyndall {
struct FroxelGrid {
    Camera camera;
    ivec2 picture{0}; // pixels
    int tile = 1;     // pixels per froxel, across and down
    ivec2 size{0};    // tiles, with those around the picture
    std::vector<float> faces;

    // The point of the picture (pixels) at planar depth z: origin + x·origin_x + y·origin_y + z (step + …).
    vec3 origin{0}, origin_x{0}, origin_y{0}, step{0}, step_x{0}, step_y{0};

    std::vector<float> slants; // per tile: metres of the line through its centre per metre of depth

    std::vector<int32_t> first_slice; // at or before the start of each of many thin, even stretches of depth
    float stretches_per_metre = 0;

    int slices() const { return static_cast<int>(faces.size()) - 1; }
    size_t tiles() const { return static_cast<size_t>(size.x) * static_cast<size_t>(size.y); }
    size_t tile_index(ivec2 at) const {
        return static_cast<size_t>(at.y) * static_cast<size_t>(size.x) + static_cast<size_t>(at.x);
    }
    // Place of a pixel among the tiles: whole numbers are their centres.
    vec2 tile_of(vec2 pixel) const { return pixel / static_cast<float>(tile) + 0.5f; }
    ivec2 tile_of_pixel(vec2 pixel) const { return glm::clamp(ivec2(tile_of(pixel) + 0.5f), ivec2(0), size - 1); }
    vec2 pixel_of(vec2 place) const { return (place - 0.5f) * static_cast<float>(tile); }
    vec3 line_step(vec2 pixel) const { return step + pixel.x * step_x + pixel.y * step_y; }
    vec3 point(vec2 pixel, float z) const {
        return origin + pixel.x * origin_x + pixel.y * origin_y + z * line_step(pixel);
    }
};

// Width of a froxel at planar depth z, metres.
inline float froxel_width(const FroxelGrid& grid, float z) {
    return static_cast<float>(grid.tile) * (glm::length(grid.origin_x) + z * glm::length(grid.step_x));
}

// As camera_ray(), without its tangent.
inline Ray line_ray(const FroxelGrid& grid, vec2 pixel) {
    const vec3 step = grid.line_step(pixel);
    const float length = glm::length(step);
    return {grid.point(pixel, 0), step / length, grid.camera.far * length};
}

// The tiles of a picture; slices follow with set_slices().
FroxelGrid make_froxel_grid(const Camera& camera, ivec2 picture, int tile);

// Slices from `near` to `far`, the last one `growth` times as thick as the first; then `tail` ever longer ones up to
// `end` (no tail when end <= far).
void set_slices(FroxelGrid& grid, float near, float far, int count, float growth, float end, int tail);

// The slice that holds a planar depth; depths outside belong to the first or last one.
inline int slice_of(const FroxelGrid& grid, float z) {
    const float place = (z - grid.faces.front()) * grid.stretches_per_metre;
    const int last = static_cast<int>(grid.first_slice.size()) - 1;
    int k = grid.first_slice[place > 0 ? (place < static_cast<float>(last) ? static_cast<int>(place) : last) : 0];
    while (k + 1 < grid.slices() && z >= grid.faces[k + 1]) ++k;
    return k;
}

// Pixel and planar depth of a point. Nothing useful (a depth of 0 or less) behind a perspective camera.
vec3 project(const FroxelGrid& grid, vec3 point);
}
