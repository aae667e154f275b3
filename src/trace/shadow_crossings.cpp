// Crossings of sixteen rays with the faces of their tile.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/shadow_crossings.cpp"
#include <hwy/foreach_target.h>

#include "trace/shadow_view.h"

#include <hwy/highway.h>

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using DoubleTag = hn::ScalableTag<double>;
constexpr size_t double_lanes = HWY_LANES(double);

// Memory that a thread keeps: on which side of each ray a corner lies, as bits, valid where the stamp is `now`.
struct Scratch {
    struct CornerSide {
        uint32_t stamp = 0, left = 0;
    };
    std::vector<CornerSide> corners;
    uint32_t now = 0;
};

struct Crossing16 {
    const ShadowView& view;
    const ShadowRays& rays;
    Scratch& scratch;
    std::vector<ShadowCrossing> (&found)[16];

    // Bits of the rays whose product is not negative.
    HWY_INLINE uint32_t not_negative(const RayProduct& f) const {
        const DoubleTag d;
        const auto x = hn::Set(d, f.x), y = hn::Set(d, f.y), z = hn::Set(d, f.z), w = hn::Set(d, f.w);
        uint32_t bits = 0;
        for (size_t i = 0; i < 16; i += double_lanes) {
            auto sum = hn::MulAdd(x, hn::Load(d, rays.p[0] + i), w);
            sum = hn::MulAdd(y, hn::Load(d, rays.p[1] + i), sum);
            sum = hn::MulAdd(z, hn::Load(d, rays.p[2] + i), sum);
            uint8_t part[8] = {};
            hn::StoreMaskBits(d, hn::Ge(sum, hn::Zero(d)), part);
            bits |= static_cast<uint32_t>(part[0]) << i;
        }
        return bits;
    }

    double product(const RayProduct& f, int ray) const {
        return f.w + f.x * rays.p[0][ray] + f.y * rays.p[1][ray] + f.z * rays.p[2][ray];
    }

    HWY_INLINE uint32_t left_of(uint32_t corner) const {
        Scratch::CornerSide& side = scratch.corners[corner];
        if (side.stamp != scratch.now) side = {scratch.now, not_negative(view.corners[corner])};
        return side.left;
    }

    // Rays that cross the edge's plane ahead, on the edge's stretch of it ...
    HWY_INLINE uint32_t crossed_ahead(const ShadowView::Edge& edge) const {
        const uint32_t a = left_of(edge.a), b = left_of(edge.b);
        return (edge.start > 0 ? a & ~b : b & ~a) & rays.active;
    }
    // ... and behind the edge as the light sees it.
    HWY_INLINE uint32_t crossed(const ShadowView::Edge& edge) const {
        const uint32_t ahead = crossed_ahead(edge);
        if (!ahead) return 0;
        const uint32_t positive = not_negative(edge.before);
        return ahead & (edge.start > 0 ? ~positive : positive);
    }

    void add_side(const ShadowView::Side& side) const {
        const ShadowView::Edge& edge = view.edges[side.edge];
        for (uint32_t left = crossed(edge); left; left &= left - 1) {
            const int ray = std::countr_zero(left);
            const double across = product(side.across, ray);
            const double t = view.parallel ? across / edge.start : edge.start / -across;
            // Beyond the end, or where lines of sight and light part.
            if (!(t < rays.end[ray]) || (!view.parallel && !(t >= 0))) continue;
            found[ray].push_back({t, rays.edges ? behind(edge, ray, t) : 0, side.change});
        }
    }

    // How far behind an edge, along the light, a ray is at t.
    double behind(const ShadowView::Edge& edge, int ray, double t) const {
        const double share =
            product(edge.before, ray) / (product(view.corners[edge.b], ray) - product(view.corners[edge.a], ray));
        if (view.light.far) return share;
        const dvec3 p(rays.p[0][ray], rays.p[1][ray], rays.p[2][ray]);
        return share * glm::distance(view.parallel ? p + t * view.forward : t * p, view.light.at);
    }

    // What a triangle's sides leave over is crossed at the triangle itself.
    void add_cap(const ShadowView::Cap& cap) const {
        uint32_t sides[3], any = cap.dark || cap.opposite ? rays.active : 0;
        int change[3];
        for (int k = 0; k < 3; ++k) {
            const ShadowView::Edge& edge = view.edges[cap.edges[k]];
            any |= sides[k] = crossed(edge);
            change[k] = (edge.start > 0) == cap.left[k] ? -1 : 1;
        }
        for (; any; any &= any - 1) {
            const int ray = std::countr_zero(any);
            int left_over = cap.dark - cap.opposite;
            for (int k = 0; k < 3; ++k)
                if (sides[k] >> ray & 1) left_over += change[k];
            if (left_over == 0) continue;
            const dvec3 p(rays.p[0][ray], rays.p[1][ray], rays.p[2][ray]);
            double t = view.parallel ? (cap.height - glm::dot(cap.normal, p)) / glm::dot(cap.normal, view.forward)
                                     : cap.height / glm::dot(cap.normal, p);
            if (!view.parallel) t = std::max(t, 0.0);
            if (t < rays.end[ray]) found[ray].push_back({t, 0, -left_over});
        }
    }

    // The faces of the rays' tile that are near enough for any of them; all when the tile is unknown.
    template<class Add> HWY_INLINE void visit(const ShadowTiles& tiles, size_t count, float end, const Add& add) const {
        if (rays.tile < 0) {
            for (uint32_t i = 0; i < count; ++i) add(i);
            return;
        }
        const size_t last = tiles.first[rays.tile + 1];
        for (size_t i = tiles.first[rays.tile]; i < last; ++i) {
            if (tiles.faces[i].nearest > end) return;
            add(tiles.faces[i].index);
        }
    }
};

void find_crossings_kernel(const ShadowView& view, const ShadowRays& rays, std::vector<ShadowCrossing> (&found)[16]) {
    static thread_local Scratch scratch;
    if (scratch.corners.size() < view.corners.size()) scratch.corners.resize(view.corners.size());
    if (++scratch.now == 0)
        std::fill(scratch.corners.begin(), scratch.corners.end(), Scratch::CornerSide{}), ++scratch.now;
    double end = -double(infinity);
    for (int ray = 0; ray < 16; ++ray)
        if (rays.active >> ray & 1) end = std::max(end, rays.end[ray]);
    const Crossing16 crossing{view, rays, scratch, found};
    const float furthest = std::nextafter(static_cast<float>(end), infinity);
    crossing.visit(view.side_tiles, view.sides.size(), furthest,
                   [&](uint32_t i) HWY_ATTR { crossing.add_side(view.sides[i]); });
    crossing.visit(view.cap_tiles, view.caps.size(), furthest,
                   [&](uint32_t i) HWY_ATTR { crossing.add_cap(view.caps[i]); });
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(find_crossings_kernel);

void find_crossings(const ShadowView& view, const ShadowRays& rays, std::vector<ShadowCrossing> (&crossings)[16]) {
    HWY_DYNAMIC_DISPATCH(find_crossings_kernel)(view, rays, crossings);
}

void append_lit(int dark, std::vector<ShadowCrossing>& crossings, Stretch range, std::vector<Stretch>& lit) {
    std::sort(crossings.begin(), crossings.end(),
              [](const ShadowCrossing& a, const ShadowCrossing& b) { return a.t < b.t; });
    const double smallest = 1e-9 * (1 + std::abs(range.high)); // what rounding leaves between faces that meet
    double from = range.low;
    for (const ShadowCrossing& crossing : crossings) {
        const double t = std::min(crossing.t, range.high);
        if (dark <= 0 && t > from + smallest) lit.push_back({from, t});
        dark += crossing.change, from = std::max(from, t);
    }
    if (dark <= 0 && range.high > from + smallest) lit.push_back({from, range.high});
}
}
#endif
