#include "volume/rays/fog_pieces.h"

#include "volume/bricks/brick_walk.h"
#include "volume/bricks/bricks.h"
#include "volume/bricks/half.h"
#include "volume/medium.h"
#include "volume/rays/spans.h"

namespace tyndall {
namespace {
constexpr double none = std::numeric_limits<double>::infinity();

struct Linear {
    double a, b; // a + b·s
};

// Expands trilinear interpolation, with weights linear in s, into cubic coefficients.
void cubic_in_cell(const uint16_t* corner, const Linear& x, const Linear& y, const Linear& z, double* c) {
    double v[8];
    for (int i = 0; i < 8; ++i) v[i] = float_from_half(corner[(i >> 2) * 81 + ((i >> 1) & 1) * 9 + (i & 1)]);
    double quadratic[2][3];
    for (int i = 0; i < 2; ++i) {
        const double* w = v + 4 * i;
        const Linear low{w[0] + z.a * (w[1] - w[0]), z.b * (w[1] - w[0])};
        const Linear high{w[2] + z.a * (w[3] - w[2]), z.b * (w[3] - w[2])};
        const Linear rise{high.a - low.a, high.b - low.b};
        quadratic[i][0] = low.a + y.a * rise.a;
        quadratic[i][1] = low.b + y.a * rise.b + y.b * rise.a;
        quadratic[i][2] = y.b * rise.b;
    }
    for (int k = 0; k < 4; ++k) c[k] = k < 3 ? quadratic[0][k] : 0;
    for (int k = 0; k < 3; ++k) {
        const double rise = quadratic[1][k] - quadratic[0][k];
        c[k] += x.a * rise, c[k + 1] += x.b * rise;
    }
}

void append_brick_density(const Ray& ray, const BrickPool& pool, double t_end, std::vector<DensityPiece>& pieces) {
    const LocalRay local = local_ray(pool, ray);
    const double voxels = glm::length(local.direction);
    walk_bricks(pool, local, {0, t_end}, [&](ivec3 brick, int64_t at, double low, double high) {
        const int32_t id = pool.index[at];
        if (id < 0) return pieces.push_back({low, high, {pool.constants[-id - 1]}, false, 0});
        const ivec3 first = brick * 8;
        const uint16_t* values = &pool.values[size_t(id - 1) * brick_stride];
        walk_cells(local, {low, high}, 1, first, first + 7, [&](ivec3 cell, double from, double to) {
            const ivec3 in = cell - first;
            const dvec3 w = local.origin + from * local.direction - dvec3(cell), &d = local.direction;
            DensityPiece piece{from, to, {}, false, voxels};
            cubic_in_cell(values + (in.x * 9 + in.y) * 9 + in.z, {w.x, d.x}, {w.y, d.y}, {w.z, d.z}, piece.c);
            if (piece.c[0] != 0 || piece.c[1] != 0 || piece.c[2] != 0 || piece.c[3] != 0) pieces.push_back(piece);
        });
    });
}

// Density 1 below the base and an exponential above it.
void append_height_density(const Ray& ray, const Medium& medium, Interval<double> inside,
                           std::vector<DensityPiece>& pieces) {
    const double start = (double(ray.origin.y) - medium.density.height_base) / medium.density.height_falloff;
    const double slope = double(ray.direction.y) / medium.density.height_falloff;
    const auto append = [&](double low, double high) {
        if (!(low < high)) return;
        const double middle = start + slope * 0.5 * (low + high);
        if (middle <= 0)
            pieces.push_back({low, high, {1}, false, 0});
        else
            pieces.push_back({low, high, {-(start + slope * low), -slope}, true, 0});
    };
    const double base = slope == 0 ? none : -start / slope;
    if (!(base > inside.low && base < inside.high)) return append(inside.low, inside.high);
    append(inside.low, base), append(base, inside.high);
}

// The next interval on which every medium stays within one piece; `at` is the end of the previous one.
Interval<double> next_stretch(const FogPieces& fog, const std::vector<int>& current, double at) {
    Interval<double> next{none, none};
    const auto begin = [&](size_t m) {
        const std::vector<DensityPiece>& pieces = fog.densities[m];
        return current[m] < static_cast<int>(pieces.size()) ? std::max(pieces[current[m]].low, at) : none;
    };
    for (size_t m = 0; m < fog.media; ++m) next.low = std::min(next.low, begin(m));
    for (size_t m = 0; m < fog.media; ++m)
        if (const double low = begin(m); low != none)
            next.high = std::min(next.high, low > next.low ? low : fog.densities[m][current[m]].high);
    return next;
}

// Merges the pieces of all media.
void merge_media(double max_depth, FogPieces& fog) {
    static thread_local std::vector<int> current;
    current.assign(fog.media, 0);
    for (double at = 0; fog.depth < max_depth;) {
        const Interval<double> next = next_stretch(fog, current, at);
        if (next.low == none) return;
        at = next.high;
        if (!next.empty()) {
            FogPieces::Piece piece{next.low, next.high, fog.depth, 0};
            for (size_t m = 0; m < fog.media; ++m) {
                const std::vector<DensityPiece>& pieces = fog.densities[m];
                const bool there = current[m] < static_cast<int>(pieces.size()) && pieces[current[m]].low <= next.low;
                fog.parts.push_back(there ? current[m] : -1);
                if (there) piece.voxels = std::max(piece.voxels, pieces[current[m]].voxels);
            }
            fog.pieces.push_back(piece);
            fog.depth = fog.depth_at(fog.pieces.size() - 1, next.high);
        }
        for (size_t m = 0; m < fog.media; ++m) {
            const std::vector<DensityPiece>& pieces = fog.densities[m];
            if (current[m] < static_cast<int>(pieces.size()) && pieces[current[m]].high <= at) ++current[m];
        }
    }
}
}

double DensityPiece::density(double t) const {
    const double s = t - low;
    if (exponential) return std::exp(c[0] + c[1] * s);
    return std::max(c[0] + s * (c[1] + s * (c[2] + s * c[3])), 0.0); // rounding may give negative values
}

double DensityPiece::column(double t) const {
    const double s = t - low;
    if (!exponential) return s * (c[0] + s * (c[1] / 2 + s * (c[2] / 3 + s * (c[3] / 4))));
    // Evaluated from the denser end to avoid overflow: e^d (1 - e^-|c1 s|) / |c1|.
    const double change = std::abs(c[1] * s), densest = std::exp(std::max(c[0], c[0] + c[1] * s));
    return change == 0 ? densest * s : densest * s * (-std::expm1(-change) / change);
}

void append_density(const Ray& ray, const Medium& medium, double t_end, std::vector<DensityPiece>& pieces) {
    if (medium.density.kind == DensityKind::bricks)
        return append_brick_density(ray, *medium.density.bricks, t_end, pieces);
    const Interval<double> inside =
        clip(medium.density.bounds, local_ray(medium.density.world_to_local, ray), {0, t_end});
    if (inside.empty()) return;
    if (medium.density.kind == DensityKind::homogeneous)
        return pieces.push_back({inside.low, inside.high, {1}, false, 0});
    append_height_density(ray, medium, inside, pieces);
}

double FogPieces::density(size_t piece, size_t medium, double t) const {
    const int part = parts[piece * media + medium];
    return part < 0 ? 0 : densities[medium][part].density(t);
}

double FogPieces::depth_at(size_t piece, double t) const {
    double sum = pieces[piece].depth;
    for (size_t m = 0; m < media; ++m) {
        const int part = parts[piece * media + m];
        if (part < 0) continue;
        const DensityPiece& density = densities[m][part];
        const double before = pieces[piece].low > density.low ? density.column(pieces[piece].low) : 0;
        sum += extinction[m] * (density.column(t) - before);
    }
    return sum;
}

void find_fog(const Ray& ray, std::span<const Medium> media, double min_transmittance, FogPieces& fog) {
    fog.pieces.clear(), fog.parts.clear(), fog.extinction.clear();
    fog.depth = 0;
    fog.media = media.size();
    fog.densities.resize(fog.media);
    if (!is_finite(ray.origin) || !is_finite(ray.direction)) fog.media = 0;
    const double t_end = fog.media == 0 ? 0 : horizon(ray, media);
    for (size_t m = 0; m < fog.media; ++m) {
        fog.extinction.push_back(gray_extinction(media[m].optics));
        fog.densities[m].clear();
        if (gray_extinction(media[m].optics) > 0) append_density(ray, media[m], t_end, fog.densities[m]);
    }
    merge_media(std::min(opaque_depth, -std::log(min_transmittance)), fog);
}
}
