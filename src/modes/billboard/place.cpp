// Cards for the openings that lights shine through.
#include "modes/billboard/search.h"
#include "modes/billboard/settings.h"

#include "base/random.h"
#include "scene/scene.h"
#include "trace/frame_cache.h"
#include "trace/occlusion/occluders.h"
#include "volume/medium.h"

#include <cmath>

namespace tyndall {
namespace {
// Fits an ellipse across `axis` to the second moments of the cells' positions; half widths are those of a uniform
// ellipse.
void fit_ellipse(const LightView& view, const std::vector<int>& cells, vec3 center, vec3 axis, BeamCard& card,
                 vec2& half) {
    vec3 u, v;
    make_frame(axis, u, v);
    float uu = 0, uv = 0, vv = 0;
    for (const int cell : cells) {
        const vec3 off = view.position(cell) - center;
        const float a = glm::dot(off, u), b = glm::dot(off, v);
        uu += a * a, uv += a * b, vv += b * b;
    }
    const float count = static_cast<float>(cells.size()), grain = view.cell_size() * view.cell_size() / 12;
    uu = uu / count + grain, vv = vv / count + grain, uv /= count;
    const float turn = 0.5f * std::atan2(2 * uv, uu - vv), c = std::cos(turn), s = std::sin(turn);
    card.across[0] = c * u + s * v, card.across[1] = c * v - s * u;
    half.x = 2 * std::sqrt(std::max(c * c * uu + 2 * c * s * uv + s * s * vv, grain));
    half.y = 2 * std::sqrt(std::max(s * s * uu - 2 * c * s * uv + c * c * vv, grain));
}

BeamCard card_of(const Openings& openings, const std::vector<int>& opening) {
    const LightView& view = openings.view;
    const std::vector<Cell>& cells = openings.cells;
    vec3 position(0);
    double from = 0, to = 0, edge = 0;
    int edges = 0;
    for (const int i : opening) {
        position += view.position(i), from += cells[i].from, to += cells[i].to;
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
            const int next = view.neighbor(i, dx, dy);
            if (next >= 0 && cells[next].opening == unlit && cells[next].hit > 0 && cells[next].hit < cells[i].hit)
                edge += cells[next].hit, ++edges;
        }
    }
    const float count = static_cast<float>(opening.size());
    BeamCard card;
    const Light& light = *view.light;
    const bool sun = is_distant(light);
    const vec3 axis = sun ? light.direction : glm::normalize(position), center = position / count;
    // The beam starts at the surfaces around the opening; cells of gaps in the open already start there.
    const float fog = static_cast<float>(from / count), end = static_cast<float>(to / count);
    float start = fog;
    if (edges > 0 && !(openings.open > 0)) start = std::max(start, static_cast<float>(edge / edges));
    start = std::min(start, glm::mix(fog, end, 0.8f));
    const vec3 origin = sun ? center : light.position;
    card.from = origin + start * axis, card.to = origin + end * axis;
    vec2 half;
    fit_ellipse(view, opening, sun ? center : axis * glm::length(center), axis, card, half);
    const float spread = sun ? light.angle : 0, shine = light.radius;
    card.half_from = sun ? half : half * start + shine;
    card.half_to = (sun ? half : half * end + shine) + spread * (end - start);
    return card;
}

// One card over the whole cone of a spot.
BeamCard cone_card(const LightView& view, const std::vector<Cell>& cells) {
    const Light& light = *view.light;
    BeamCard card;
    double sum = 0, count = 0;
    for (const Cell& cell : cells)
        if (cell.hit > 0) sum += cell.to, ++count;
    // A half angle between inner and outer cone, within the squared falloff of KHR_lights_punctual.
    const float length = static_cast<float>(sum / std::max(count, 1.0));
    const float half = std::tan(std::min(0.3f * light.inner_cone + 0.7f * light.outer_cone, 1.4f));
    make_frame(light.direction, card.across[0], card.across[1]);
    card.from = light.position, card.to = light.position + length * light.direction;
    card.half_from = vec2(std::max(light.radius, 1e-3f * length)), card.half_to = vec2(half * length);
    return card;
}

void place_for(const Snapshot& snapshot, int index, const BillboardSettings& settings, std::vector<BeamCard>& cards,
               float& open) {
    const Light& light = snapshot.lights[index];
    const bool blocked = shadow_casters(light, snapshot) != nullptr;
    if (settings.cards == 0 || (!blocked && !has_cone(light))) return;
    const Openings openings = find_openings(light, snapshot);
    open = openings.open;
    const auto add = [&](BeamCard card) {
        if (!(glm::length(card.to - card.from) > light.core)) return;
        card.light = index, card.name = "beam " + std::to_string(cards.size() + 1) + " of " + light.name;
        if (open > 0) card.tint = vec3(settings.gaps);
        card.seed = hash(static_cast<uint32_t>(index), static_cast<uint32_t>(cards.size()));
        cards.push_back(card);
    };
    if (has_cone(light)) {
        size_t in_cone = 0, largest = 0;
        for (const Cell& cell : openings.cells) in_cone += cell.hit > 0;
        for (const auto& opening : openings.found) largest = std::max(largest, opening.size());
        if (10 * largest > 6 * in_cone) return add(cone_card(openings.view, openings.cells));
    }
    std::vector<std::vector<int>> parts;
    for (const auto& opening : openings.found) {
        const int count = 1 + static_cast<int>(std::min(static_cast<float>(opening.size()) / openings.large, 63.0f));
        const auto pieces = cut(openings.view, opening, count);
        parts.insert(parts.end(), pieces.begin(), pieces.end());
    }
    std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
    parts.resize(std::min(parts.size(), static_cast<size_t>(settings.cards)));
    for (const auto& part : parts) add(card_of(openings, part));
}

void place_by_hand(const Snapshot& snapshot, std::vector<BeamCard>& cards) {
    if (!snapshot.scene) return;
    for (const Billboard& billboard : snapshot.scene->billboards)
        for (size_t l = 0; l < snapshot.lights.size(); ++l) {
            if (snapshot.lights[l].name != billboard.light) continue;
            BeamCard card;
            card.name = billboard.name, card.light = static_cast<int>(l);
            card.from = billboard.from, card.to = billboard.to;
            make_frame(glm::normalize(card.to - card.from), card.across[0], card.across[1]);
            card.half_from = vec2(0.5f * billboard.width_from), card.half_to = vec2(0.5f * billboard.width_to);
            card.tint = billboard.tint * billboard.intensity;
            card.seed = hash(0xca4du, static_cast<uint32_t>(cards.size()));
            cards.push_back(card);
        }
}

struct PlacedCards {
    std::vector<BeamCard> cards;
    std::vector<float> open; // per light
};

PlacedCards placed(const Snapshot& snapshot, const BillboardSettings& settings) {
    PlacedCards result;
    result.open.assign(snapshot.lights.size(), 0);
    place_by_hand(snapshot, result.cards);
    for (size_t l = 0; l < snapshot.lights.size(); ++l)
        place_for(snapshot, static_cast<int>(l), settings, result.cards, result.open[l]);
    return result;
}

// Everything that cards depend on: surfaces, positions of lights and fog, and search settings.
CacheKey card_key(const Snapshot& snapshot, const BillboardSettings& settings) {
    CacheKey key;
    key.add(snapshot.occluders).add(snapshot.bounds).add(snapshot.extent).add(snapshot.lights.size());
    for (const Light& light : snapshot.lights) {
        key.add(light).add(light.name.size()).add(shadow_casters(light, snapshot));
        key.bits += light.name;
    }
    for (const Medium& medium : snapshot.media) key.add(medium.world_bounds);
    return key.add(settings.cards).add(settings.gaps);
}
}

std::vector<BeamCard> place_cards(const Snapshot& snapshot, const BillboardSettings& settings,
                                  std::vector<float>* open) {
    const auto found =
        cached(snapshot, "beam cards", card_key(snapshot, settings), [&] { return placed(snapshot, settings); });
    if (open) *open = found->open;
    return found->cards;
}
}
