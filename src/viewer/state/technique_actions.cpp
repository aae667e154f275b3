// Actions on techniques and their settings.
#include "base/error.h"
#include "modes/mode.h"
#include "viewer/painting/reference_picture.h"
#include "viewer/state/setting_groups.h"
#include "viewer/state/verb_actions.h"

namespace tyndall {
namespace {
void set_mode(ViewState& state, const Action& action) {
    state.mode = find_mode(action.words[0]).name;
    ++state.revision;
}

void set_beside(ViewState& state, const Action& action) {
    const std::string name = action.words.empty() ? "" : action.words[0];
    state.beside = name.empty() || name == reference_name ? name : std::string(find_mode(name).name);
    ++state.revision;
}

void set_quality(ViewState& state, const Action& action) {
    state.quality = quality_named(action.words[0]);
    state.settings = settings_for(state.quality);
    ++state.revision;
}

void set_orders(ViewState& state, const Action& action) {
    const std::string& text = action.words[0];
    const Mode& mode = find_mode(state.mode);
    const std::string row = mode.surfaces == Surfaces::own ? "path.orders" : "fluence.orders";
    if (!mode.adds_fluence && mode.surfaces != Surfaces::own)
        fail(ExitCode::usage, "orders", state.mode + " scatters light once only; march, froxel and path take more");
    apply_setting(state.settings, row + "=" + (text == "all" ? std::to_string(all_orders) : text));
    ++state.revision;
}

void set_setting(ViewState& state, const Action& action) {
    apply_setting(state.settings, action.words[0] + "=" + action.words[1]);
    ++state.revision;
}

void reset_setting(ViewState& state, const Action& action) {
    const Settings usual = settings_for(state.quality);
    if (action.words[0] == "all") {
        state.settings = usual;
    } else {
        const SettingRow& row = find_row(action.words[0], "reset");
        row.set(state.settings, row.get(usual));
    }
    ++state.revision;
}

constexpr VerbAction table[] = {
    {Verb::mode, set_mode},     {Verb::beside, set_beside}, {Verb::quality, set_quality},
    {Verb::orders, set_orders}, {Verb::set, set_setting},   {Verb::reset, reset_setting},
};
}

std::span<const VerbAction> technique_actions() { return table; }
}
