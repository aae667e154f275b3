#include "modes/billboard/limitations.h"

#include "modes/area_light_limitations.h"
#include "modes/billboard/billboard.h"
#include "modes/billboard/settings.h"
#include "modes/lens_fog.h"
#include "modes/light_filters.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Reports a camera inside a card, or looking along its beam.
void add_card(const BeamCard& card, vec3 camera, Limitations& limitations) {
    constexpr float edge_on = 0.94f; // cosine
    if (off_axis(card, camera) < 1)
        limitations.push_back({Severity::wrong, &limitation::camera_in_card, Subject::card, card.name});
    const vec3 axis = glm::normalize(card.to - card.from);
    const vec3 towards = glm::normalize(0.5f * (card.from + card.to) - camera);
    if (std::abs(glm::dot(axis, towards)) > edge_on)
        limitations.push_back({Severity::degraded, &limitation::card_edge_on, Subject::card, card.name});
}
}

Limitations billboard_limitations(const View& view, const Snapshot& snapshot, const Settings& settings) {
    Limitations limitations;
    if (std::ranges::any_of(snapshot.media, [](const Medium& medium) { return medium.majorant() > 0; }))
        limitations.push_back({Severity::wrong, &limitation::cards, Subject::image});
    std::vector<float> open;
    const std::vector<BeamCard> cards = place_cards(snapshot, settings.of<BillboardSettings>(), &open);
    for (const BeamCard& card : cards) add_card(card, view.camera.position, limitations);
    for (size_t l = 0; l < snapshot.lights.size(); ++l) {
        const auto has_light = [&](const BeamCard& card) { return card.light == static_cast<int>(l); };
        const std::string& name = snapshot.lights[l].name;
        if (open[l] > 0) limitations.push_back({Severity::degraded, &limitation::open_light, Subject::light, name});
        if (std::ranges::none_of(cards, has_light))
            limitations.push_back({Severity::info, &limitation::no_opening, Subject::light, name});
    }
    add_mean_filters(snapshot, limitations);
    add_fog_through_middle(view, snapshot, limitations);
    add_left_out_light(snapshot, settings.terms.emission, limitations);
    add_lamps_for_faces(view, snapshot, limitations);
    if (snapshot.media.empty()) limitations.push_back({Severity::info, &limitation::no_fog, Subject::scene});
    for (const Medium& medium : snapshot.media)
        limitations.push_back({Severity::degraded, &limitation::homogeneous_in_cards, Subject::medium, medium.name});
    add_to_every_mode(view, snapshot, limitations);
    return limitations;
}
}
