#include "volume/rays/emission_nodes.h"

#include "base/gauss_legendre.h"
#include "volume/bricks/brick_walk.h"
#include "volume/bricks/half.h"

namespace tyndall {
namespace {
constexpr float faint = 1e-6f;      // of the brightest
constexpr float dark_share = 1e-3f; // of a cell's brightest corner: darker ones ask for no more parts
constexpr float dim = 1e-4f;        // of the brightest: cells that are no brighter have one part
constexpr float change = 1.5f;      // of the light's logarithm, across a part

// Into how many parts a cell is cut, by its corners.
int parts_of(const uint16_t* corner) {
    uint16_t low = 0xffff, high = 0;
    for (const int at : {0, 1, 9, 10, 81, 82, 90, 91})
        low = std::min(low, corner[at]), high = std::max(high, corner[at]);
    const float most = float_from_half(high);
    if (most <= dim) return 1;
    const float least = std::max(float_from_half(low), dark_share * most);
    return std::max(1, static_cast<int>(std::ceil(std::log(most / least) / change)));
}
}

void find_emission_nodes(const BrickPool& luminance, const Ray& ray, const std::function<void(EmissionNode)>& add) {
    const LocalRay local = local_ray(luminance, ray);
    const auto add_part = [&](double low, double high) {
        for (const QuadratureNode& node : gauss_legendre(2))
            add({static_cast<float>(low + (high - low) * node.at), static_cast<float>((high - low) * node.weight)});
    };
    walk_bricks(luminance, local, {0, ray.t_max}, [&](ivec3 brick, int64_t at, double low, double high) {
        if (luminance.maximum[at] <= faint) return;
        const int32_t id = luminance.index[at];
        const uint16_t* values = id > 0 ? &luminance.values[size_t(id - 1) * brick_stride] : nullptr;
        const ivec3 first = brick * 8;
        walk_cells(local, {low, high}, 1, first, first + 7, [&](ivec3 cell, double from, double to) {
            const ivec3 in = cell - first;
            const int parts = values ? parts_of(values + (in.x * 9 + in.y) * 9 + in.z) : 1;
            for (int i = 0; i < parts; ++i)
                add_part(from + (to - from) * i / parts, from + (to - from) * (i + 1) / parts);
        });
    });
}
}
