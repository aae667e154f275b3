#include "volume/rays/emission_nodes.h"

#include "base/gauss_legendre.h"
#include "volume/bricks/brick_walk.h"
#include "volume/bricks/half.h"

namespace tyndall {
namespace {
constexpr float not_asked = 1e-6f;  // relative to the brightest; bricks below are skipped
constexpr float dark_share = 1e-3f; // relative to a cell's brightest corner; darker corners are clamped to this
constexpr float dim = 1e-4f;        // relative to the brightest; cells below get one part
constexpr float change = 1.5f;      // maximum change of log luminance across one part

int parts_of(const EmissionCell& cell) {
    if (cell.most <= dim) return 1;
    return std::max(
        1, static_cast<int>(std::ceil(std::log(cell.most / std::max(cell.least, dark_share * cell.most)) / change)));
}
}

void find_emission_cells(const BrickPool& luminance, const Ray& ray, float faint,
                         const std::function<void(const EmissionCell&)>& add) {
    const LocalRay local = local_ray(luminance, ray);
    walk_bricks(luminance, local, {0, ray.t_max}, [&](ivec3 brick, int64_t at, double low, double high) {
        if (luminance.maximum[static_cast<size_t>(at)] <= faint) return;
        const int32_t id = luminance.index[static_cast<size_t>(at)];
        const uint16_t* values = id > 0 ? &luminance.values[size_t(id - 1) * brick_stride] : nullptr;
        const float even = id < 0 ? luminance.constants[static_cast<size_t>(-id - 1)] : 0;
        const ivec3 first = brick * 8;
        walk_cells(local, {low, high}, 1, first, first + 7, [&](ivec3 cell, double from, double to) {
            if (!values) return add({from, to, even, even});
            const ivec3 in = cell - first;
            const uint16_t* corner = values + (in.x * 9 + in.y) * 9 + in.z;
            uint16_t least = 0xffff, most = 0; // the bit patterns of halves sort like their values
            for (const int i : {0, 1, 9, 10, 81, 82, 90, 91})
                least = std::min(least, corner[i]), most = std::max(most, corner[i]);
            add({from, to, float_from_half(most), float_from_half(least)});
        });
    });
}

void find_emission_nodes(const BrickPool& luminance, const Ray& ray, const std::function<void(EmissionNode)>& add) {
    find_emission_cells(luminance, ray, not_asked, [&](const EmissionCell& cell) {
        const int parts = parts_of(cell);
        const double length = (cell.high - cell.low) / parts;
        for (int i = 0; i < parts; ++i)
            for (const QuadratureNode& node : gauss_legendre(2))
                add({static_cast<float>(cell.low + length * (i + node.at)), static_cast<float>(length * node.weight)});
    });
}
}
