// Environment light: its radiance by direction, and importance sampling of directions.
#pragma once
#include "trace/snapshot.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tyndall {
struct EnvironmentSource;
struct SurfacePoint;

// Cells of a latitude-longitude map, sampled by luminance times solid angle: first the row, then the column.
struct DirectionTable {
    ivec2 texels{1}; // of the map
    ivec2 cells{1};  // each `factor` texels wide and high; the last ones may be smaller
    int factor = 1;
    std::vector<double> rows, columns; // cumulative: cells.y + 1, and cells.y × (cells.x + 1)
    std::vector<float> pdfs;           // of each cell, 1/sr
    vec3 mean{0};                      // radiance, over the sphere
};

struct Environment {
    std::string name;
    BackgroundState map; // never a backplate
    vec3 scale{1};       // multiplies the map
    float volume_scale = 1, surface_scale = 1;
    bool shadows = true;
    int casters = -1, lit = -1; // as in Light
    std::shared_ptr<const DirectionTable> table;

    vec3 mean() const { return table->mean * map.intensity * scale; }
};

// Null if the map is black. Reuses the sampling table of `previous` (may be null) if it has the same image.
std::shared_ptr<const Environment> make_environment(BackgroundState map, const Environment* previous = nullptr);

// The scene's environment at a moment; `links`: its sets of casters (x) and of lit instances (y). Null if there is none
// or it is black. Throws Error (refused) if its radiance overflows a float.
std::shared_ptr<const Environment> environment_at(const Scene& scene, const Moment& moment, ivec2 links,
                                                  const Environment* previous);

vec3 environment_radiance(const Environment& environment, vec3 direction);

struct EnvironmentSample {
    vec3 direction{0, 1, 0}, radiance{0};
    float pdf = 0; // 1/sr
};
EnvironmentSample sample_environment(const Environment& environment, vec2 u);

// Pdf, 1/sr, with which sample_environment() picks a direction.
float environment_pdf(const Environment& environment, vec3 direction);

// Adds reflected environment light to the radiance of up to 16 Lambertian surfaces. Each takes n pairs of directions,
// one by radiance and one by cosine, combined by the balance heuristic. `u`: points × n sample pairs.
void add_environment(const Snapshot& snapshot, std::span<const SurfacePoint> points, std::span<const vec2> u,
                     std::span<vec3> radiance);
}
