// Quads of beam cards for the current camera.
#include "modes/billboard/billboard.h"
#include "modes/billboard/settings.h"

#include "base/random.h"
#include "integrate/style.h"
#include "modes/light_filters.h"
#include "scene/light.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
float smoothstep(float low, float high, float x) {
    const float s = std::clamp((x - low) / std::max(high - low, 1e-6f), 0.0f, 1.0f);
    return s * s * (3 - 2 * s);
}

CardQuad quad_of(const BeamCard& card, int index) {
    CardQuad quad;
    quad.card = index, quad.light = card.light, quad.tint = card.tint;
    quad.axis = glm::normalize(card.to - card.from);
    quad.across[0] = card.across[0], quad.across[1] = card.across[1];
    quad.width_from = card.half_from, quad.width_to = card.half_to;
    quad.seed = 64 * to_unit(card.seed);
    return quad;
}

// Places the quad in the plane through the beam's center with this normal.
void lay(const BeamCard& card, vec3 normal, CardQuad& quad) {
    const vec3 middle = 0.5f * (card.from + card.to);
    const auto onto = [&](vec3 point) { return point - glm::dot(point - middle, normal) * normal; };
    const vec3 start = onto(card.from), way = onto(card.to) - start;
    quad.normal = normal, quad.start = start, quad.length = glm::length(way);
    quad.along = quad.length > 0 ? way / quad.length : quad.axis;
    quad.side = glm::cross(normal, quad.along);
    const vec2 toward(glm::dot(quad.side, card.across[0]), glm::dot(quad.side, card.across[1]));
    quad.half_from = glm::length(toward * card.half_from), quad.half_to = glm::length(toward * card.half_to);
}

void add_quads(const BeamCard& card, int index, const Camera& camera, CardFacing facing, float share,
               std::vector<CardQuad>& quads) {
    CardQuad quad = quad_of(card, index);
    quad.share = share;
    const auto add = [&](vec3 normal) {
        lay(card, normal, quad);
        if (quad.length > 0) quads.push_back(quad);
    };
    const vec3 middle = 0.5f * (card.from + card.to);
    const vec3 to_eye = camera.ortho_height > 0 ? -camera.forward : glm::normalize(camera.position - middle);
    if (facing == CardFacing::camera) return add(-camera.forward);
    if (facing == CardFacing::cross) {
        quad.crossed = true;
        add(card.across[0]);
        return add(card.across[1]);
    }
    const vec3 normal = to_eye - glm::dot(to_eye, quad.axis) * quad.axis;
    if (glm::length(normal) > 1e-4f) add(glm::normalize(normal));
}

// Adds the quad to its group: edges are planes through the eye, positive on the quad's side.
void join_group(const CardQuad& quad, const Camera& camera, int place, CardGroup& group) {
    dvec3 corners[4];
    group.nearest[place] = infinity;
    for (int k = 0; k < 4; ++k) {
        const bool far = k >= 2;
        const float across = (k == 0 || k == 3 ? -1.0f : 1.0f) * (far ? quad.half_to : quad.half_from);
        const vec3 offset = quad.start + (far ? quad.length : 0) * quad.along + across * quad.side - camera.position;
        const float depth = glm::dot(offset, camera.forward);
        corners[k] = {glm::dot(offset, camera.right), glm::dot(offset, camera.up), camera.ortho_height > 0 ? 1 : depth};
        group.nearest[place] = std::min(group.nearest[place], depth);
    }
    const dvec3 middle = corners[0] + corners[1] + corners[2] + corners[3];
    for (int k = 0; k < 4; ++k) {
        dvec3 edge = glm::cross(corners[k], corners[(k + 1) % 4]);
        if (glm::dot(edge, middle) < 0) edge = -edge;
        for (int axis = 0; axis < 3; ++axis) group.edges[k][axis][place] = static_cast<float>(edge[axis]);
    }
}

std::vector<CardGroup> grouped(const std::vector<CardQuad>& quads, const Camera& camera) {
    std::vector<CardGroup> groups((quads.size() + 15) / 16);
    for (CardGroup& group : groups) std::ranges::fill(group.nearest, infinity);
    for (size_t i = 0; i < quads.size(); ++i) join_group(quads[i], camera, static_cast<int>(i % 16), groups[i / 16]);
    return groups;
}
}

float off_axis(const BeamCard& card, vec3 point) {
    const vec3 way = card.to - card.from, off = point - card.from;
    const float length = glm::length(way), share = glm::dot(off, way) / (length * length);
    if (share < 0 || share > 1) return infinity;
    const vec2 half = glm::max(glm::mix(card.half_from, card.half_to, share), vec2(1e-7f * length));
    return glm::length(vec2(glm::dot(off, card.across[0]), glm::dot(off, card.across[1])) / half);
}

Billboards make_billboards(const View& view, const Snapshot& snapshot, const Settings& settings) {
    Billboards billboards;
    const std::vector<BeamCard> cards = place_cards(snapshot, settings.of<BillboardSettings>(), &billboards.veils);
    for (float& veil : billboards.veils)
        veil *= settings.of<BillboardSettings>().veil * settings.of<BillboardSettings>().brightness;
    billboards.settings = settings.of<BillboardSettings>(), billboards.style = settings.style;
    billboards.snapshot = stylized(snapshot, settings.style);
    average_filters(billboards.snapshot);
    billboards.snapshot.media = homogeneous_media(billboards.snapshot.media);
    billboards.camera = view.camera;
    billboards.seconds = static_cast<float>(snapshot.seconds);
    billboards.pixel = view_height(view.camera) / static_cast<float>(std::max(view.size.y, 1));
    for (size_t i = 0; i < cards.size(); ++i) {
        const BeamCard& card = cards[i];
        // Each card's brightness sways with its own frequency and phase.
        const float pace = 0.08f + 0.17f * to_unit(hash(card.seed, 1u)), phase = to_unit(hash(card.seed, 2u));
        const float swing = 0.5f + 0.5f * std::sin(2 * pi * (pace * billboards.seconds + phase));
        const float inside = smoothstep(0.5f, 4, off_axis(card, view.camera.position));
        const float share =
            (1 - settings.of<BillboardSettings>().sway * swing) * inside * settings.of<BillboardSettings>().brightness;
        if (share > 0)
            add_quads(card, static_cast<int>(i), view.camera, settings.of<BillboardSettings>().facing, share,
                      billboards.quads);
    }
    billboards.groups = grouped(billboards.quads, view.camera);
    return billboards;
}
}
