// Beam cards: a look, not light. Cards stand where light leaks in and are drawn as textured quads.
#include "modes/billboard.h"

#include "base/random.h"
#include "modes/style.h"
#include "modes/techniques.h"

namespace tyndall {
namespace {
constexpr float veil_share = 0.5f; // of the open air's fog that is taken for lit

float smooth(float low, float high, float x) {
    const float s = std::clamp((x - low) / std::max(high - low, 1e-6f), 0.0f, 1.0f);
    return s * s * (3 - 2 * s);
}

// How far a point is from the beam's axis, in half widths of the beam there; infinite before and behind it.
float off_axis(const BeamCard& card, vec3 point) {
    const vec3 way = card.to - card.from, off = point - card.from;
    const float length = glm::length(way), share = glm::dot(off, way) / (length * length);
    if (share < 0 || share > 1) return infinity;
    const vec2 half = glm::max(glm::mix(card.half_from, card.half_to, share), vec2(1e-6f));
    return glm::length(vec2(glm::dot(off, card.across[0]), glm::dot(off, card.across[1])) / half);
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

// Lays the quad into the plane through the beam's middle with this normal.
void lay(const BeamCard& card, vec3 normal, CardQuad& quad) {
    const vec3 middle = 0.5f * (card.from + card.to);
    const auto onto = [&](vec3 point) { return point - glm::dot(point - middle, normal) * normal; };
    const vec3 start = onto(card.from), way = onto(card.to) - start;
    quad.normal = normal, quad.start = start, quad.length = glm::length(way);
    quad.along = quad.length > 1e-6f ? way / quad.length : quad.axis;
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
        if (quad.length > 1e-6f) quads.push_back(quad);
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

// A handful of names in one line.
std::string some_of(const std::vector<std::string>& names) {
    std::string line;
    for (size_t i = 0; i < std::min<size_t>(names.size(), 5); ++i) line += (i ? ", " : "") + names[i];
    return names.size() > 5 ? line + " and " + std::to_string(names.size() - 5) + " more" : line;
}

bool eye_inside(const BeamCard& card, vec3 eye) { return off_axis(card, eye) < 1; }
}

Billboards make_billboards(const View& view, const Snapshot& snapshot, const Settings& settings) {
    Billboards billboards;
    const std::vector<BeamCard> cards = place_cards(snapshot, settings.billboard, &billboards.veils);
    for (float& veil : billboards.veils) veil *= veil_share * settings.billboard.brightness;
    billboards.settings = settings.billboard, billboards.style = settings.style;
    billboards.snapshot = stylised(snapshot, settings.style);
    billboards.snapshot.media = even_media(billboards.snapshot.media);
    billboards.eye = view.camera.position;
    billboards.seconds = static_cast<float>(snapshot.seconds);
    const float height = view.camera.ortho_height > 0 ? 0 : 2 * std::tan(0.5f * view.camera.vertical_fov);
    billboards.pixel = height / static_cast<float>(std::max(view.size.y, 1));
    for (size_t i = 0; i < cards.size(); ++i) {
        const BeamCard& card = cards[i];
        // Each card swings at its own pace.
        const float pace = 0.08f + 0.17f * to_unit(hash(card.seed, 1u)), phase = to_unit(hash(card.seed, 2u));
        const float swing = 0.5f + 0.5f * std::sin(2 * pi * (pace * billboards.seconds + phase));
        const float inside = smooth(0.5f, 4, off_axis(card, view.camera.position));
        const float share = (1 - settings.billboard.sway * swing) * inside * settings.billboard.brightness;
        if (share > 0)
            add_quads(card, static_cast<int>(i), view.camera, settings.billboard.facing, share, billboards.quads);
    }
    return billboards;
}

std::vector<Limit> billboard_limits(const View& view, const Snapshot& snapshot, const Settings& settings) {
    std::vector<Limit> limits{
        {Severity::wrong, "billboard", "cards are a look: they are not lit, shadowed or made of fog"}};
    std::vector<float> open;
    const std::vector<BeamCard> cards = place_cards(snapshot, settings.billboard, &open);
    std::vector<std::string> around, along;
    for (const BeamCard& card : cards) {
        if (eye_inside(card, view.camera.position)) around.push_back(card.name);
        const vec3 axis = glm::normalize(card.to - card.from);
        const vec3 look = glm::normalize(0.5f * (card.from + card.to) - view.camera.position);
        if (std::abs(glm::dot(axis, look)) > 0.94f) along.push_back(card.name);
    }
    if (!around.empty())
        limits.push_back({Severity::wrong, some_of(around), "the camera is inside: such cards are faded out"});
    if (!along.empty())
        limits.push_back(
            {Severity::degraded, some_of(along), "seen along the beam, where a card is thin: it fades out"});
    for (size_t l = 0; l < snapshot.lights.size(); ++l)
        if (open[l] > 0)
            limits.push_back({Severity::degraded, "light " + snapshot.lights[l].name,
                              "shines in the open: cards stand in gaps only, the rest is a veil without shadows"});
    for (size_t l = 0; l < snapshot.lights.size(); ++l)
        if (std::ranges::none_of(cards, [&](const BeamCard& card) { return card.light == static_cast<int>(l); }))
            limits.push_back({Severity::info, "light " + snapshot.lights[l].name,
                              "no opening found that it shines through: no card"});
    if (snapshot.media.empty()) limits.push_back({Severity::info, "media", "there is no fog for cards to show"});
    for (const Medium& medium : snapshot.media)
        limits.push_back({Severity::degraded, "medium " + medium.name, "seen as even, and only through the cards"});
    return limits;
}

ScatterFunction prepare_billboard(const View& view, const Snapshot& snapshot, const Settings& settings, History*) {
    const auto billboards = std::make_shared<const Billboards>(make_billboards(view, snapshot, settings));
    return [billboards](const RayBatch& batch, std::span<Scatter> results) {
        billboard_packet(*billboards, batch, results);
    };
}
}
