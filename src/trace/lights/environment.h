// Light that arrives from all around: its radiance by direction, and directions picked by it.
#pragma once
#include "trace/snapshot.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tyndall {
struct EnvironmentSource;
struct SurfacePoint;

// Cells of a latitude-longitude map and the chances of picking one: luminance times solid angle, a row first.
struct DirectionTable {
    ivec2 texels{1}; // of the map
    ivec2 cells{1};  // each `factor` texels wide and high; the last ones may be cut
    int factor = 1;
    std::vector<double> rows, columns; // cumulative: cells.y + 1, and cells.y × (cells.x + 1)
    std::vector<float> densities;      // of each cell, 1/sr
    vec3 mean{0};                      // radiance, over the sphere
};

struct Environment {
    std::string name;
    BackgroundNow map; // never a plate
    vec3 scale{1};     // multiplies the map
    float volume_scale = 1, surface_scale = 1;
    bool shadows = true;
    int casters = -1, lit = -1; // as those of a Light
    std::shared_ptr<const DirectionTable> table;

    vec3 mean() const { return table->mean * map.intensity * scale; }
};

// Null where the map is black. What the map's table was made for before (may be null) is used again.
std::shared_ptr<const Environment> make_environment(BackgroundNow map, const Environment* previous = nullptr);

// The scene's at a moment, with its sets of casters (x) and of instances that it lights (y); null where there is none
// or it is black. Throws Error (refused) for light beyond floats.
std::shared_ptr<const Environment> environment_at(const Scene& scene, double seconds, ivec2 links,
                                                  const Environment* previous);

vec3 environment_radiance(const Environment& environment, vec3 direction);

struct EnvironmentSample {
    vec3 direction{0, 1, 0}, radiance{0};
    float density = 0; // 1/sr
};
EnvironmentSample sample_environment(const Environment& environment, vec2 u);

// With which sample_environment() picks a direction, 1/sr.
float environment_density(const Environment& environment, vec3 direction);

// Adds to the radiance of up to 16 Lambert surfaces what they scatter of the environment's light, by n pairs of
// directions for each: by the light and by the cosine, which share it (balance heuristic). `u`: points × n pairs of
// numbers.
void add_environment(const Snapshot& snapshot, std::span<const SurfacePoint> points, std::span<const vec2> u,
                     std::span<vec3> radiance);
}
