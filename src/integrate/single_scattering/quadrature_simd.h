// Places quadrature nodes on the lit intervals of rays; part of the single-scattering kernel (see base/simd/simd.h for
// how such files are compiled).
#if defined(TYNDALL_INTEGRATE_SINGLE_SCATTERING_QUADRATURE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_SINGLE_SCATTERING_QUADRATURE_SIMD_H
#undef TYNDALL_INTEGRATE_SINGLE_SCATTERING_QUADRATURE_SIMD_H
#else
#define TYNDALL_INTEGRATE_SINGLE_SCATTERING_QUADRATURE_SIMD_H
#endif

#include "integrate/single_scattering/single_scattering_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Maximum angle, seen from a local light, that one quadrature rule may span; smaller for narrow phase functions.
double widest_angle(const SingleScattering& frame) {
    float g = 0;
    for (const Medium& medium : frame.snapshot.media)
        if (!medium.optics.phase.shape) g = std::max(g, std::abs(mean_cosine(medium.optics.phase)));
    return std::min(0.8, 4 * (1 - double(g)));
}

// Far along the ray the angle hardly changes but the fog does: parts end at ±1, ±3, ±9 ... times the light's distance.
double next_bound(double x) {
    double bound = 1;
    while (bound <= std::abs(x)) bound *= 3;
    if (x >= -1) return bound;
    return -bound / (bound / 3 < -x ? 3 : 9);
}

// The next cut for a narrow lobe after x.
double next_cut(const LobeCuts& cuts, double x) {
    for (int i = 0; i < cuts.count; ++i)
        if (double(cuts.slopes[i]) > x) return double(cuts.slopes[i]);
    return infinity;
}

// A piece of a ray without kinks in the integrand.
struct Piece {
    int light;
    size_t ray;
    int cut;
    double low, high;
    bool soft = false; // in the soft edge of a spot light
};

// Number of equal parts of at most `widest` in the angle between two slopes.
double angular_parts(double from, double to, double widest) {
    if (widest >= 0.8) return 1; // bounds are never farther apart
    return std::ceil((std::atan(to) - std::atan(from)) / widest);
}

// The quadrature rule of a piece. The soft edge of a spot light, a fourth-degree polynomial, needs more nodes.
std::span<const QuadratureNode> rule_for(const Packet& packet, const Piece& piece) {
    if (piece.light >= 0) {
        const size_t light = static_cast<size_t>(piece.light);
        if (packet.frame.shadows[light].by == ShadowMethod::rays || packet.frame.filter_steps[light].sampled)
            return {&packet.jittered[piece.ray], 1};
    }
    const int more = piece.soft ? 2 : 0;
    if (!packet.frame.sampled) return gauss_legendre(packet.frame.nodes + more);
    return gauss_legendre(packet.spread == Spread::angle ? 2 + more / 2 : 1);
}

// Maximum angle that one quadrature rule may span on a piece lit by a local light, also limited by its filter.
double widest_angle(const Packet& packet, const Piece& piece) {
    const double smooth = packet.frame.sampled ? 1 : widest_angle(packet.frame);
    const FilterSteps& steps = packet.frame.filter_steps[static_cast<size_t>(piece.light)];
    if (steps.angle == 0) return smooth;
    const LightAlong& along = packet.scratch.along[piece.ray];
    const EquiAngular<double> whole = along.angles(along.lit.front().low, along.lit.back().high);
    return std::min(smooth, std::max(steps.angle, (whole.to - whole.from) / steps.parts));
}

void push_equi_angular(Packet& packet, const Piece& piece) {
    const std::span<const QuadratureNode> rule = rule_for(packet, piece);
    const double nearest = packet.scratch.along[piece.ray].nearest, away = packet.away[piece.ray];
    const double end = (piece.high - nearest) / away, widest = widest_angle(packet, piece);
    for (double x = (piece.low - nearest) / away; x < end;) {
        const double next = std::min({next_bound(x), next_cut(packet.frame.lobe, x), end}),
                     parts = angular_parts(x, next, widest);
        for (double i = 0; i < parts; ++i)
            for (const QuadratureNode& node : rule)
                push_node(packet, piece.light, piece.ray, piece.cut, x * away, next * away, (i + node.at) / parts,
                          node.weight / parts);
        x = next;
    }
}

void push_piece(Packet& packet, const Piece& piece) {
    if (packet.spread == Spread::angle) return push_equi_angular(packet, piece);
    for (const QuadratureNode& node : rule_for(packet, piece))
        push_node(packet, piece.light, piece.ray, piece.cut, piece.low, piece.high, node.at, node.weight);
}

// True if a piece between cuts contains visible fog.
HWY_INLINE bool has_visible_fog(const Packet& packet, size_t ray, int cut) {
    if (!packet.frame.sampled) return true;
    const float* depth = packet.scratch.depth.data() + 16 * static_cast<size_t>(cut) + ray;
    return depth[0] * packet.frame.style.view_depth < packet.frame.opaque && depth[16] > depth[0];
}

bool in_soft_edge(const LightAlong& along, Interval<double> piece) {
    if (!has_cone(*along.light)) return false;
    const dvec3 from = along.origin + 0.5 * (piece.low + piece.high) * along.direction - dvec3(along.light->position);
    const double cosine = glm::dot(from, dvec3(along.light->direction)) / glm::length(from);
    return cosine * along.cone_scale + along.cone_offset < 1;
}

HWY_INLINE void note_whole(Packet& packet, size_t ray, int cut) {
    if (has_visible_fog(packet, ray, cut))
        packet.scratch.whole[16 * static_cast<size_t>(cut) + ray] += static_cast<float>(packet.light_share);
}

// Splits lit intervals at the cuts of the fog and at the light's kinks, which are the ends of `reached` intervals.
void push_lit(Packet& packet, int light, size_t ray, std::span<const Interval<double>> lit,
              std::span<const Interval<double>> reached) {
    const float* at = packet.scratch.cuts.at.data() + ray;
    const int pieces = packet.scratch.cuts.pieces[ray];
    int cut = 0;
    for (size_t piece = 0; piece < reached.size(); ++piece) {
        const Interval<double> within = reached[piece];
        const bool soft = packet.spread == Spread::angle && in_soft_edge(packet.scratch.along[ray], within);
        for (const Interval<double>& stretch : lit) {
            double low = std::max<double>({stretch.low, within.low, at[0]});
            const double end = std::min(stretch.high, within.high);
            while (low < end) {
                while (cut < pieces && at[16 * (cut + 1)] <= low) ++cut;
                if (cut == pieces) return;
                const double high = std::min<double>(end, at[16 * (cut + 1)]);
                if (packet.full_steps && low == at[16 * cut] && high == at[16 * (cut + 1)])
                    note_whole(packet, ray, cut);
                else if (has_visible_fog(packet, ray, cut))
                    push_piece(packet, {light, ray, cut, low, high, soft});
                low = high;
            }
        }
    }
}
}
}
HWY_AFTER_NAMESPACE();
#endif
