// Beam cards: a look, not light. Cards stand where light leaks in and are drawn as textured quads.
#include "modes/billboard/billboard.h"
#include "modes/billboard/settings.h"

#include "modes/mode.h"
#include "scene/light.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// A handful of names in one line.
std::string some_of(const std::vector<std::string>& names) {
    std::string line;
    for (size_t i = 0; i < std::min<size_t>(names.size(), 5); ++i) line += (i ? ", " : "") + names[i];
    return names.size() > 5 ? line + " and " + std::to_string(names.size() - 5) + " more" : line;
}
}

std::vector<Limit> billboard_limits(const View& view, const Snapshot& snapshot, const Settings& settings) {
    std::vector<Limit> limits;
    if (std::ranges::any_of(snapshot.media, [](const Medium& medium) { return medium.majorant() > 0; }))
        limits.push_back({Severity::wrong, "billboard", "cards are a look: they are not lit, shadowed or made of fog"});
    std::vector<float> open;
    const std::vector<BeamCard> cards = place_cards(snapshot, settings.of<BillboardSettings>(), &open);
    std::vector<std::string> around, along;
    for (const BeamCard& card : cards) {
        if (off_axis(card, view.camera.position) < 1) around.push_back(card.name);
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

Mode billboard_mode() {
    return {.name = "billboard",
            .summary = "textured beam cards where light leaks into the scene: a look, not light",
            .accuracy = Accuracy::look,
            .surfaces = Surfaces::shared,
            .limits = billboard_limits,
            .prepare = prepare_billboard,
            .append_rows = append_billboard_rows,
            .rungs = billboard_rungs,
            .color = "#B8A900",
            .interactive = true};
}
}
