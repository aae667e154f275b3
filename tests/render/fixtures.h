// Scenes of a few planes, and modes of one line, so that every pixel has a closed form.
#pragma once
#include "base/image.h"
#include "base/math.h"
#include "integrate/ray_batch.h"

#include <cstring>
#include <vector>

namespace tyndall {
struct Camera;
struct History;
struct Limitation;
struct Medium;
struct Mode;
struct Scene;
struct Settings;
struct Snapshot;
struct View;
}

namespace tyndall::test {
// A square of side 2·half in the plane z, facing +z, glowing with `emission`.
void add_plane(Scene& scene, float z, float half, vec3 emission, float alpha = 1);

// A view along -z from the origin.
Camera plain_camera(float ortho_height = 0);

View plain_view(ivec2 size, int samples, float ortho_height = 0);

// A moment of a scene made by hand; the scene has to outlive it.
Snapshot snapshot_of(const Scene& scene);
Snapshot snapshot_of(const Scene& scene, std::vector<Medium> media);

std::vector<Limitation> no_limitations(const View&, const Snapshot&, const Settings&);

Mode mode_of(ScatterFunction (*prepare)(const View&, const Snapshot&, const Settings&, History*));

// Fog of the first medium's extinction all along the ray, glowing so that endless fog has radiance `fog_radiance`. Each
// light is said to give an equal part.
inline constexpr vec3 fog_radiance{0.5f, 0.25f, 1.0f};

ScatterFunction prepare_emissive(const View&, const Snapshot& snapshot, const Settings&, History*);

ScatterFunction prepare_nothing(const View&, const Snapshot&, const Settings&, History*);

// Light that depends on everything a mode is told, neighbors included.
ScatterFunction prepare_everything(const View&, const Snapshot&, const Settings&, History*);

// Of pictures: whether they agree in every bit, and the pixels from `low` to before `high`.
template<class T> bool same_bits(const Image<T>& a, const Image<T>& b) {
    return a.size == b.size && std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(T)) == 0;
}

template<class T> Image<T> cut(const Image<T>& image, ivec2 low, ivec2 high) {
    Image<T> result(high - low);
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x) result.at(x - low.x, y - low.y) = image.at(x, y);
    return result;
}
}
