// Crossings of sixteen rays with the faces of their tile.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/shadows/volumes/shadow_crossings.cpp"
#include <hwy/foreach_target.h>

#include "trace/shadows/volumes/shadow_view.h"

#include <hwy/highway.h>

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using DoubleTag = hn::ScalableTag<double>;
constexpr size_t double_lanes = HWY_LANES(double);

// Scratch memory of a thread: for each corner, the rays that it lies to the left of; for each edge, the rays that cross
// it; as bits, valid if the stamp is `now`.
struct Scratch {
    struct Bits {
        uint32_t stamp = 0, rays = 0;
    };
    std::vector<Bits> corners, edges;
    uint32_t now = 0;

    void begin(const ShadowView& view) {
        if (corners.size() < view.corners.size()) corners.resize(view.corners.size());
        if (edges.size() < view.edges.size()) edges.resize(view.edges.size());
        if (++now > 0) return;
        std::fill(corners.begin(), corners.end(), Bits{}), std::fill(edges.begin(), edges.end(), Bits{});
        ++now;
    }
};

struct Crossing16 {
    const ShadowView& view;
    const ShadowViewRays& rays;
    Scratch& scratch;
    std::vector<ShadowCrossing>& found;

    // Calls `each` with an index into the rays and the products of one register of rays from there on.
    template<class Each> HWY_INLINE void products(const RayProduct& f, const Each& each) const {
        const DoubleTag d;
        const auto x = hn::Set(d, f.x), y = hn::Set(d, f.y), z = hn::Set(d, f.z), w = hn::Set(d, f.w);
        for (size_t i = 0; i < 16; i += double_lanes) {
            auto sum = hn::MulAdd(x, hn::Load(d, rays.p[0] + i), w);
            sum = hn::MulAdd(y, hn::Load(d, rays.p[1] + i), sum);
            each(i, hn::MulAdd(z, hn::Load(d, rays.p[2] + i), sum));
        }
    }
    template<class Mask> HWY_INLINE static uint32_t bits_of(Mask mask, size_t first) {
        uint8_t part[8] = {};
        hn::StoreMaskBits(DoubleTag(), mask, part);
        return static_cast<uint32_t>(part[0]) << first;
    }

    // Bits of the rays whose product is not negative.
    HWY_INLINE uint32_t not_negative(const RayProduct& f) const {
        uint32_t bits = 0;
        products(f, [&](size_t i, auto sum) HWY_ATTR { bits |= bits_of(hn::Ge(sum, hn::Zero(DoubleTag())), i); });
        return bits;
    }

    double product(const RayProduct& f, int ray) const {
        return f.w + f.x * rays.p[0][ray] + f.y * rays.p[1][ray] + f.z * rays.p[2][ray];
    }

    HWY_INLINE uint32_t left_of(uint32_t corner) const {
        Scratch::Bits& known = scratch.corners[corner];
        if (known.stamp != scratch.now) known = {scratch.now, not_negative(view.corners[corner])};
        return known.rays;
    }

    // Rays that cross the edge's side: ahead of the eye, between its corners, and behind the edge as the light sees it.
    HWY_INLINE uint32_t find_crossed(const ShadowView::Edge& edge) const {
        const uint32_t a = left_of(edge.a), b = left_of(edge.b);
        const uint32_t ahead = (edge.start > 0 ? a & ~b : b & ~a) & rays.active;
        if (!ahead) return 0;
        const uint32_t positive = not_negative(edge.before);
        return ahead & (edge.start > 0 ? ~positive : positive);
    }
    HWY_INLINE uint32_t crossed(uint32_t edge) const {
        Scratch::Bits& known = scratch.edges[edge];
        if (known.stamp != scratch.now) known = {scratch.now, find_crossed(view.edges[edge])};
        return known.rays;
    }

    // Crossings of a side, except those beyond a ray's end or behind the eye.
    void add_side(const ShadowView::Side& side) const {
        const uint32_t there = crossed(side.edge);
        if (!there) return;
        const DoubleTag d;
        const ShadowView::Edge& edge = view.edges[side.edge];
        ShadowCrossing& row = found.emplace_back();
        uint32_t seen = 0;
        products(side.across, [&](size_t i, auto across) HWY_ATTR {
            const uint8_t bits[8] = {static_cast<uint8_t>(there >> i)};
            const auto start = hn::Set(d, edge.start);
            const auto at = view.parallel ? hn::Div(across, start) : hn::Div(start, hn::Neg(across));
            auto reached = hn::And(hn::LoadMaskBits(d, bits), hn::Lt(at, hn::Load(d, rays.end + i)));
            if (!view.parallel) reached = hn::And(reached, hn::Ge(at, hn::Zero(d)));
            const auto t = hn::IfThenElse(reached, hn::Sub(at, hn::Load(d, rays.start + i)), hn::Set(d, infinity));
            hn::Store(hn::DemoteTo(hn::Rebind<float, DoubleTag>(), t), hn::Rebind<float, DoubleTag>(), row.t + i);
            seen |= bits_of(reached, i);
        });
        if (!seen) return found.pop_back();
        std::fill(row.change, row.change + 16, static_cast<float>(side.change));
        for (uint32_t left = rays.edges ? seen : 0; left; left &= left - 1) {
            const int ray = std::countr_zero(left);
            row.behind[ray] = static_cast<float>(behind_edge(edge, ray, row.t[ray] + rays.start[ray]));
        }
    }

    // Distance along the light from an edge to a ray at t.
    double behind_edge(const ShadowView::Edge& edge, int ray, double t) const {
        const double share =
            product(edge.before, ray) / (product(view.corners[edge.b], ray) - product(view.corners[edge.a], ray));
        if (view.light.far) return share;
        const dvec3 p(rays.p[0][ray], rays.p[1][ray], rays.p[2][ray]);
        return share * glm::distance(view.parallel ? p + t * view.forward : t * p, view.light.at);
    }

    // Where a ray's crossings with a triangle's sides do not cancel, it crosses the triangle itself.
    void add_cap(const ShadowView::Cap& cap) const {
        uint32_t up[3], down[3]; // rays whose count each side raises, and lowers
        for (int k = 0; k < 3; ++k) {
            const uint32_t rays_there = crossed(cap.edges[k]);
            const bool lowers = (view.edges[cap.edges[k]].start > 0) == cap.left[k];
            up[k] = lowers ? 0 : rays_there, down[k] = lowers ? rays_there : 0;
        }
        // Rays for which the numbers of raising and lowering sides differ, counted in two bits each.
        const auto ones = [](const uint32_t(&v)[3]) { return v[0] ^ v[1] ^ v[2]; };
        const auto twos = [](const uint32_t(&v)[3]) { return (v[0] & v[1]) | (v[1] & v[2]) | (v[2] & v[0]); };
        const int offset = cap.dark - cap.opposite;
        uint32_t any = offset ? rays.active : (ones(up) ^ ones(down)) | (twos(up) ^ twos(down));
        if (!any) return;
        ShadowCrossing& row = found.emplace_back();
        std::fill(row.t, row.t + 16, infinity);
        bool seen = false;
        for (; any; any &= any - 1) {
            const int ray = std::countr_zero(any);
            int left_over = offset;
            for (int k = 0; k < 3; ++k)
                left_over += static_cast<int>(up[k] >> ray & 1) - static_cast<int>(down[k] >> ray & 1);
            if (left_over == 0) continue;
            const dvec3 p(rays.p[0][ray], rays.p[1][ray], rays.p[2][ray]);
            double t = view.parallel ? (cap.height - glm::dot(cap.normal, p)) / glm::dot(cap.normal, view.forward)
                                     : cap.height / glm::dot(cap.normal, p);
            if (!view.parallel) t = std::max(t, 0.0);
            if (!(t < rays.end[ray])) continue;
            seen = true;
            row.t[ray] = static_cast<float>(t - rays.start[ray]), row.change[ray] = static_cast<float>(-left_over);
        }
        if (!seen) found.pop_back();
    }

    // Visits the faces of the rays' tile up to a distance; all faces if the tile is unknown.
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

void find_crossings_kernel(const ShadowView& view, const ShadowViewRays& rays, std::vector<ShadowCrossing>& found) {
    static thread_local Scratch scratch;
    scratch.begin(view);
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

void find_crossings(const ShadowView& view, const ShadowViewRays& rays, std::vector<ShadowCrossing>& crossings) {
    HWY_DYNAMIC_DISPATCH(find_crossings_kernel)(view, rays, crossings);
}
}
#endif
