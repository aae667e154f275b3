#include "modes/path/limitations.h"

#include "modes/area_light_limitations.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

namespace tyndall {
Limitations path_limitations(const View& view, const Snapshot& snapshot, const Settings& settings) {
    constexpr float hardly_absorbing = 0.995f; // albedo
    Limitations limitations;
    for (const Medium& medium : snapshot.media)
        if (!is_finite(medium.world_bounds.size()) && max_component(medium.optics.albedo) > hardly_absorbing)
            limitations.push_back({Severity::info, &limitation::long_paths, Subject::medium, medium.name});
    if (settings.terms.emission) add_out_of_gamut(snapshot, limitations);
    if (settings.path.orders < all_orders)
        limitations.push_back({Severity::info,
                               &limitation::orders_left_out,
                               Subject::setting,
                               "path.orders",
                               {static_cast<double>(settings.path.orders)}});
    add_to_every_mode(view, snapshot, limitations);
    return limitations;
}
}
