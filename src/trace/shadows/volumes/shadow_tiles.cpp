// Bins faces into the image tiles that they cover. Sides are quads with two corners at infinity, so they are clipped
// and projected in homogeneous coordinates.
#include "trace/shadows/volumes/shadow_view.h"

namespace tyndall {
namespace {

// A point in the camera's axes: x right, y up, z forward; w = 0 at infinity.
using Point = glm::dvec4;

// The image's projection: pixel = (x/depth, y/depth) scaled, with depth the z of a perspective, the w of an
// orthographic camera.
struct Projection {
    dvec3 position, right, up, forward;
    bool orthographic;
    double half_width, half_height; // of the image at depth 1, margin included
    dvec3 pixels;                   // x: pixels per unit at depth 1; y, z: the image's center
    ivec2 tiles;
    double margin;

    double depth(const Point& p) const { return orthographic ? p.w : p.z; }
    Point seen(dvec3 p, double w) const {
        const dvec3 from = w == 0 ? p : p - position;
        return {glm::dot(right, from), glm::dot(up, from), glm::dot(forward, from), w};
    }
};

Projection make_projection(const Camera& camera, ivec2 size, float margin) {
    Projection p{
        dvec3(camera.position), dvec3(camera.right), dvec3(camera.up), dvec3(camera.forward), {}, {}, {}, {}, {}, {}};
    p.orthographic = camera.ortho_height > 0;
    const double half = p.orthographic ? 0.5 * camera.ortho_height : std::tan(0.5 * double(camera.vertical_fov));
    const double scale = 0.5 * size.y / half;
    p.margin = margin + 0.05;
    p.half_width = (0.5 * size.x + p.margin) / scale, p.half_height = (0.5 * size.y + p.margin) / scale;
    p.pixels = {scale, 0.5 * size.x, 0.5 * size.y};
    p.tiles = (size + shadow_tile_side - 1) / shadow_tile_side;
    return p;
}

// A convex polygon, clipped in place.
struct Polygon {
    Point at[12];
    int count = 0;

    template<class Distance> void clip(const Distance& distance) {
        Polygon rest;
        for (int i = 0; i < count; ++i) {
            const Point &a = at[i], &b = at[(i + 1) % count];
            const double da = distance(a), db = distance(b);
            if (da >= 0) rest.at[rest.count++] = a;
            if ((da >= 0) != (db >= 0)) rest.at[rest.count++] = a + (b - a) * (da / (da - db));
        }
        *this = rest;
    }
};

// The tiles of a row that a face covers.
struct Span {
    uint32_t face;
    int row, low, high; // tiles low..high
};

struct Collector {
    const Projection& projection;
    std::vector<Interval<int>> wanted; // tiles of each row to fill; the rest stays empty
    std::vector<Span> spans;
    std::vector<float> nearest; // of each face

    void cover(uint32_t face, int row, double low, double high) {
        const auto tile = [&](double x) {
            return std::clamp(static_cast<int>(std::floor(std::clamp(x, -1e6, 1e6) / shadow_tile_side)), 0,
                              projection.tiles.x - 1);
        };
        const Interval<int> of_row = wanted[static_cast<size_t>(row)];
        const int first = std::max(tile(low - projection.margin), of_row.low);
        const int last = std::min(tile(high + projection.margin), of_row.high);
        if (first <= last) spans.push_back({face, row, first, last});
    }

    void add(uint32_t face, Polygon polygon) {
        const Projection& p = projection;
        nearest.push_back(infinity);
        polygon.clip([&](const Point& q) { return p.depth(q); });
        polygon.clip([&](const Point& q) { return p.depth(q) * p.half_width - q.x; });
        polygon.clip([&](const Point& q) { return p.depth(q) * p.half_width + q.x; });
        polygon.clip([&](const Point& q) { return p.depth(q) * p.half_height - q.y; });
        polygon.clip([&](const Point& q) { return p.depth(q) * p.half_height + q.y; });
        if (polygon.count == 0) return;

        double x[12], y[12], bottom = infinity, top = -double(infinity), near = infinity;
        bool endless = false; // through the eye, or seen edge-on
        for (int i = 0; i < polygon.count; ++i) {
            const Point& q = polygon.at[i];
            const double depth = p.depth(q), size = std::abs(q.x) + std::abs(q.y) + std::abs(q.z) + std::abs(q.w);
            endless |= !(depth > 1e-9 * size);
            x[i] = p.pixels.y + p.pixels.x * q.x / depth, y[i] = p.pixels.z - p.pixels.x * q.y / depth;
            bottom = std::min(bottom, y[i]), top = std::max(top, y[i]);
            if (q.w > 0)
                near = std::min(near, q.z / q.w);
            else if (q.z < 0)
                near = -double(infinity);
        }
        if (endless) {
            nearest.back() = -infinity;
            for (int row = 0; row < p.tiles.y; ++row) cover(face, row, -1e6, 1e6);
            return;
        }
        nearest.back() = static_cast<float>(near - 1e-5 * (1 + std::abs(near)));
        const auto row_of = [&](double at) {
            return std::clamp(static_cast<int>(std::floor(at / shadow_tile_side)), 0, p.tiles.y - 1);
        };
        for (int row = row_of(bottom - p.margin); row <= row_of(top + p.margin); ++row) {
            const double from = row * shadow_tile_side - p.margin, to = (row + 1) * shadow_tile_side + p.margin;
            double low = infinity, high = -double(infinity);
            for (int i = 0; i < polygon.count; ++i) {
                const int j = (i + 1) % polygon.count;
                if (std::max(y[i], y[j]) < from || std::min(y[i], y[j]) > to) continue;
                const auto at = [&](double level) {
                    if (y[i] == y[j]) return x[i];
                    return x[i] + (x[j] - x[i]) * std::clamp((level - y[i]) / (y[j] - y[i]), 0.0, 1.0);
                };
                double ends[2] = {at(from), at(to)};
                if (y[i] == y[j]) ends[1] = x[j];
                low = std::min({low, ends[0], ends[1]}), high = std::max({high, ends[0], ends[1]});
            }
            if (low <= high) cover(face, row, low, high);
        }
    }

    // Faces by tile, the nearest first.
    ShadowTiles sorted() const {
        std::vector<uint32_t> order(spans.size());
        for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        std::stable_sort(order.begin(), order.end(),
                         [&](uint32_t a, uint32_t b) { return nearest[spans[a].face] < nearest[spans[b].face]; });
        ShadowTiles tiles;
        const int width = projection.tiles.x;
        tiles.first.assign(static_cast<size_t>(width) * projection.tiles.y + 1, 0);
        for (const Span& span : spans)
            for (int tile = span.low; tile <= span.high; ++tile) ++tiles.first[span.row * width + tile + 1];
        for (size_t i = 1; i < tiles.first.size(); ++i) tiles.first[i] += tiles.first[i - 1];
        tiles.faces.resize(tiles.first.back());
        std::vector<uint32_t> next(tiles.first.begin(), tiles.first.end() - 1);
        for (const uint32_t i : order)
            for (int tile = spans[i].low; tile <= spans[i].high; ++tile)
                tiles.faces[next[spans[i].row * width + tile]++] = {nearest[spans[i].face], spans[i].face};
        return tiles;
    }
};
}

namespace {
// The tiles of each row that a beam covers: those of the surface of a pyramid around it, which extends to infinity.
std::vector<Interval<int>> tiles_in_cone(const Projection& projection, const std::optional<ShadowCone>& reach) {
    const std::vector<Interval<int>> all(static_cast<size_t>(projection.tiles.y), {0, projection.tiles.x - 1});
    if (!reach) return all;
    constexpr int edges = 8;
    const double wide = 1.001 * std::tan(reach->half_angle) / std::cos(double{pi} / edges);
    vec3 across, up;
    make_frame(vec3(reach->axis), across, up);
    const auto edge = [&](int i) {
        const double angle = 2 * double{pi} * i / edges;
        return projection.seen(reach->axis + wide * (std::cos(angle) * dvec3(across) + std::sin(angle) * dvec3(up)), 0);
    };
    Collector surface{projection, all, {}, {}};
    for (int i = 0; i < edges; ++i) {
        surface.add(0, {{projection.seen(reach->apex, 1), edge(i), edge(i + 1)}, 3});
        surface.add(0, {{edge(0), edge(i), edge(i + 1)}, 3});
    }
    std::vector<Interval<int>> tiles(all.size(), {projection.tiles.x, -1});
    for (const Span& span : surface.spans) {
        Interval<int>& row = tiles[static_cast<size_t>(span.row)];
        row.low = std::min(row.low, span.low), row.high = std::max(row.high, span.high);
    }
    return tiles;
}
}

void fill_tiles(const ShadowVolumes& volumes, const Camera& camera, ivec2 size, float margin, ShadowView& view) {
    const Projection projection = make_projection(camera, size, margin);
    const ShadowMesh& mesh = *volumes.mesh;
    const std::vector<Interval<int>> wanted = tiles_in_cone(projection, volumes.reach);
    Collector sides{projection, wanted, {}, {}}, caps{projection, wanted, {}, {}};
    for (uint32_t i = 0; i < view.sides.size(); ++i) {
        const ShadowMesh::Edge edge = mesh.edges[view.sides[i].edge];
        const dvec3 a = mesh.corners[edge.a], b = mesh.corners[edge.b];
        sides.add(i, {{projection.seen(a, 1), projection.seen(b, 1), projection.seen(-towards(volumes.light, b), 0),
                       projection.seen(-towards(volumes.light, a), 0)},
                      4});
    }
    for (uint32_t i = 0; i < view.caps.size(); ++i) {
        Polygon polygon;
        for (const uint32_t corner : mesh.triangles[volumes.caps[i].triangle].corners)
            polygon.at[polygon.count++] = projection.seen(mesh.corners[corner], 1);
        caps.add(i, polygon);
    }
    view.tiles = projection.tiles;
    view.side_tiles = sides.sorted(), view.cap_tiles = caps.sorted();
}
}
