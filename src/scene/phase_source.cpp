#include "scene/phase_source.h"

namespace tyndall {
Phase phase_at(const PhaseSource& source, float g, double seconds) {
    const float own_g = source.g.at(seconds);
    switch (source.kind) {
    case PhaseKind::draine:
        return draine_phase(own_g, source.alpha.at(seconds));
    case PhaseKind::mie:
        return mie_phase(source.droplet_diameter.at(seconds));
    case PhaseKind::mix:
        return mixed_phase(source.weight.at(seconds), phase_at(source.lobes[0], 0, seconds),
                           phase_at(source.lobes[1], 0, seconds));
    case PhaseKind::table:
    case PhaseKind::legendre:
        return {source.kind, 0, source.shape};
    default:
        return {source.kind, source.own_numbers ? own_g : g};
    }
}
}
