#include "measure/plan/terms.h"

#include "base/text.h"
#include "modes/mode.h"
#include "render/adaptive/candidates.h"
#include "render/adaptive/goal.h"
#include "scene/light.h"
#include "trace/fluence/scattering_orders.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

#include <optional>

namespace tyndall {
namespace {
// An image to compare with the reference.
struct Variant {
    const Mode* mode;
    Snapshot snapshot;
    Settings settings;
};

// The march, except that fog does not attenuate surfaces and background.
Mode undimmed_march() {
    Mode mode = main_mode();
    mode.prepare = [](const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
        const ScatterFunction inner = main_mode().prepare(view, snapshot, settings, history);
        return ScatterFunction([inner](const RayBatch& batch, std::span<Scatter> results) {
            inner(batch, results);
            for (Scatter& result : results) result.transmittance = 1;
        });
    };
    return mode;
}

// Settings at which the march is accurate enough to measure terms: its own errors cancel.
Settings careful(const Settings& settings) {
    for (const Candidate& candidate : ladder_of(main_mode(), settings))
        if (candidate.name == "final") {
            Settings result = candidate.settings;
            result.pixel.samples = settings.pixel.samples;
            return result;
        }
    return settings;
}

struct Terms {
    const View& view;
    const Snapshot& snapshot;
    const Settings base;
    double error; // the target
    const TermControl& control;
    std::optional<Pilot> pilot{}, marched{}; // made when first needed
    std::vector<Term> terms{};

    const FrameOptions frame_options{false, nullptr, control.cancel, {}, {}};

    Pilot make(const Settings& truth) const {
        Pilot result =
            make_pilot(main_mode(), view, snapshot, &truth, uniform_chances(view, snapshot), 0, frame_options);
        while (!result.is_full()) grow(result);
        return result;
    }
    const Pilot& usual() {
        if (!pilot) pilot.emplace(make(base));
        return *pilot;
    }
    const Pilot& with_marched_light() {
        if (marched) return *marched;
        Settings truth = base;
        truth.terms.light = LightTransmittance::marched;
        return marched.emplace(make(truth));
    }
    SquaredError error_of(const Pilot& against, const Variant& variant) const {
        PilotRun run{*variant.mode, variant.settings, nullptr, &variant.snapshot};
        return measure(against, run, steady_seconds).integrator;
    }

    // Root mean square over mean of the image's color or of its fog light, whichever is larger: E is at most this times
    // the largest relative error of a pixel.
    double contrast() {
        double squares[2] = {}, means[2] = {}, weights[2] = {};
        const std::vector<vec3>& values = usual().truth;
        for (size_t i = 0; i < values.size(); ++i) {
            if (!is_finite(values[i])) continue;
            const double weight = usual().tiles[i / pilot_values].weight;
            squares[i % 2] += weight * glm::dot(values[i], values[i]) / 3;
            means[i % 2] += weight * (values[i].x + values[i].y + values[i].z) / 3, weights[i % 2] += weight;
        }
        double most = 1;
        for (int layer = 0; layer < 2; ++layer)
            if (means[layer] > 0) most = std::max(most, std::sqrt(squares[layer] * weights[layer]) / means[layer]);
        return most;
    }

    // Adds a term. `most` bounds the relative error of every pixel without it; infinite if no bound is known. The term
    // is measured only if that bound is too large.
    template<class MakeVariant>
    void add(Term term, double most, const Pilot& (Terms::*against)(), const MakeVariant& variant) {
        const double allowed = term_share * error, bound = most == 0 ? 0 : most * contrast();
        if (bound <= allowed) {
            term.error = term.bound = bound, term.rigorous = true, term.needed = false;
            if (term.why.empty())
                term.why =
                    bound == 0 ? "no effect in this scene" : "no pixel changes by more than " + percent_text(most);
        } else {
            const SquaredError seen = error_of((this->*against)(), variant());
            term.error = std::sqrt(seen.value), term.bound = std::sqrt(seen.bound);
            term.needed = term.bound > allowed;
            term.why = percent_text(term.error) + " measured, at most " + percent_text(term.bound);
        }
        terms.push_back(std::move(term));
    }

    Variant changed() const { return {&main_mode(), snapshot, base}; }
};

// The snapshot without the shadows of one light, also at the moments of the shutter, which may have fewer lights.
Snapshot without_shadows(Snapshot snapshot, size_t light) {
    snapshot.lights[light].shadows = false;
    if (!snapshot.moments) return snapshot;
    std::vector<Snapshot> moments = *snapshot.moments;
    for (Snapshot& moment : moments)
        for (Light& one : moment.lights)
            if (one.name == snapshot.lights[light].name) one.shadows = false;
    snapshot.moments = std::make_shared<const std::vector<Snapshot>>(std::move(moments));
    return snapshot;
}

void add_shadows(Terms& terms) {
    for (size_t i = 0; i < terms.snapshot.lights.size(); ++i) {
        const Light& light = terms.snapshot.lights[i];
        Term term{"shadows", light.name, "left out"};
        const bool blocked = shadow_casters(light, terms.snapshot) != nullptr;
        if (!light.shadows)
            term.why = "shadows are off for this light in the scene";
        else if (!blocked)
            term.why = "nothing in the scene could cast them";
        terms.add(term, blocked ? infinity : 0, &Terms::usual, [&] {
            Variant variant = terms.changed();
            variant.snapshot = without_shadows(std::move(variant.snapshot), i);
            return variant;
        });
    }
}

// Left out or approximated: the relative error of 1 in place of exp(-d) is e^d - 1.
void add_dimming(Terms& terms, double thickest) {
    const std::pair<LightTransmittance, const char*> ways[] = {{LightTransmittance::off, "left out"},
                                                               {LightTransmittance::average, "average"},
                                                               {LightTransmittance::froxel, "froxels"},
                                                               {LightTransmittance::grid, "grid"}};
    if (terms.snapshot.lights.empty()) return;
    for (const auto& [way, name] : ways) {
        const double bound = way == LightTransmittance::off ? std::expm1(thickest) : infinity;
        terms.add({"light-side transmittance", "", name}, bound, &Terms::with_marched_light, [&, way = way] {
            Variant variant = terms.changed();
            variant.settings.terms.light = way;
            return variant;
        });
        if (!terms.terms.back().needed) return;
    }
}

// Relative error of isotropic scattering in the direction in which the fog scatters least.
double phase_bound(const Snapshot& snapshot) {
    double most = 0;
    for (const Medium& medium : snapshot.media)
        most = std::max(most, 1 / (4 * std::numbers::pi * min_phase_value(medium.optics.phase)) - 1);
    return most > 1e-6 ? most : 0;
}

void add_switches(Terms& terms) {
    const Snapshot& snapshot = terms.snapshot;
    const auto any_medium = [&](auto&& says) { return std::ranges::any_of(snapshot.media, says); };
    const auto without = [&](bool TermSettings::*term) {
        return [&terms, term] {
            Variant variant = terms.changed();
            variant.settings.terms.*term = false;
            return variant;
        };
    };
    const bool bricks = any_medium([](const Medium& medium) { return medium.density.kind == DensityKind::bricks; });
    terms.add({"varying density", "", "homogeneous fog"}, bricks ? infinity : 0, &Terms::usual,
              without(&TermSettings::heterogeneity));
    terms.add({"phase function", "", "isotropic"}, phase_bound(snapshot), &Terms::usual, without(&TermSettings::phase));
    const bool glows =
        any_medium([](const Medium& medium) { return max_component(medium.optics.emission.radiance) > 0; });
    terms.add({"emission", "", "left out"}, glows ? infinity : 0, &Terms::usual, without(&TermSettings::emission));
    const bool ambient = max_component(snapshot.ambient) > 0 || snapshot.environment;
    terms.add({"ambient light in fog", "", "left out"}, ambient ? infinity : 0, &Terms::usual,
              without(&TermSettings::ambient));
}

void add_surfaces(Terms& terms, double thickest) {
    const Mode undimmed = undimmed_march();
    terms.add({"fog in front of surfaces", "", "left out"}, std::expm1(thickest), &Terms::usual, [&] {
        Variant variant = terms.changed();
        variant.mode = &undimmed;
        return variant;
    });
}
}

namespace {
// The power that is scattered more than once over that scattered once; taken as an error, since the image lacks it.
void add_orders(Terms& terms) {
    const ScatteringRatio found = measured_ratio(terms.snapshot);
    Term term{"multiple scattering", "", "left out", found.ratio, found.high};
    term.needed = term.bound > term_share * terms.error;
    term.why =
        formatted("multiple scattering adds %s to single scattering (%s to %s)", percent_text(found.ratio).c_str(),
                  percent_text(found.low).c_str(), percent_text(found.high).c_str());
    const double bound = truncation_bound(terms.snapshot, 1);
    if (bound < 1) term.why += formatted("; never more than %s of the brightest", percent_text(bound).c_str());
    if (terms.base.fluence.orders < 2) term.why += "; ignored without --orders all";
    terms.terms.push_back(std::move(term));
}
}

std::string percent_text(double share) {
    return share < infinity ? formatted(share < 0.0995 ? "%.2g %%" : "%.0f %%", 100 * share) : "any";
}

double max_optical_depth(const Snapshot& snapshot) {
    double depth = 0;
    for (const Medium& medium : snapshot.media) {
        const vec3 size = medium.world_bounds.size();
        depth += is_finite(size) ? medium.majorant() * glm::length(size) : infinity;
    }
    return depth;
}

std::vector<Term> terms_of(const View& view, const Snapshot& snapshot, const Settings& settings, double error,
                           const TermControl& control) {
    if (snapshot.media.empty()) return {};
    Terms terms{view, snapshot, careful(settings), error, control};
    const double thickest = max_optical_depth(snapshot);
    const auto done = [&](double share) {
        if (control.progress) control.progress(share);
    };
    if (!snapshot.lights.empty()) add_orders(terms);
    add_shadows(terms), done(0.3);
    add_dimming(terms, thickest), done(0.7);
    add_switches(terms), done(0.9);
    add_surfaces(terms, thickest), done(1);
    return std::move(terms.terms);
}

Settings drop_unneeded(const std::vector<Term>& terms, Settings settings) {
    TermSettings& switches = settings.terms;
    bool shadows = false, needless = false;
    for (const Term& term : terms) {
        if (term.name == "shadows") (term.needed ? shadows : needless) |= term.bound > 0;
        if (term.name == "multiple scattering" && !term.needed) settings.fluence.orders = 1;
        if (term.needed || term.bound == 0) continue; // switching off what is not there changes nothing
        if (term.name == "light-side transmittance" && term.simpler == "left out")
            switches.light = LightTransmittance::off;
        if (term.name == "light-side transmittance" && term.simpler == "average")
            switches.light = LightTransmittance::average;
        if (term.name == "varying density") switches.heterogeneity = false;
        if (term.name == "phase function") switches.phase = false;
        if (term.name == "emission") switches.emission = false;
        if (term.name == "ambient light in fog") switches.ambient = false;
    }
    if (needless && !shadows) settings.march.visibility = Visibility::off;
    return settings;
}
}
