#include "modes/mode.h"
#include "base/error.h"
#include "base/text.h"
#include "modes/settings.h"

#include <algorithm>

namespace tyndall {
const Mode& mode_of_all_orders() { return *std::ranges::find(modes(), Accuracy::multiple_scattering, &Mode::accuracy); }

const Mode& interactive_mode() { return *std::ranges::find(modes(), true, &Mode::interactive); }

std::string main_mode_name() { return std::string(main_mode().name); }
std::string interactive_mode_name() { return std::string(interactive_mode().name); }

const Mode& find_mode(std::string_view name, std::string_view where) {
    std::vector<std::string> names;
    for (const Mode& mode : modes()) {
        if (mode.name == name) return mode;
        names.emplace_back(mode.name);
    }
    fail(ExitCode::usage, where, unknown_name("mode", name, names));
}

bool honors_style(const Mode& mode) { return mode.surfaces != Surfaces::own; }

std::string row_prefix(const Mode& mode) {
    std::string prefix(mode.name);
    std::ranges::replace(prefix, '-', '_');
    return prefix;
}

bool reads(const Mode& mode, std::string_view row) {
    const std::string_view prefix = row.substr(0, row.find('.'));
    if (prefix == "pixel") return true;
    if (prefix == "style") return honors_style(mode);
    if (prefix == "fluence") return mode.adds_fluence;
    if (prefix == "terms") // terms.light* applies to surfaces too, which most modes leave to the renderer
        return row.starts_with("terms.light") ? mode.surfaces != Surfaces::own : mode.accuracy != Accuracy::artistic;
    return prefix == row_prefix(mode) || prefix == mode.also_reads;
}

bool is_unbiased(const Mode& mode) {
    return mode.surfaces == Surfaces::own && mode.accuracy == Accuracy::multiple_scattering;
}

std::string_view name_of(Accuracy accuracy) {
    constexpr std::string_view names[] = {"artistic", "homogeneous fog", "single scattering", "multiple scattering"};
    return names[static_cast<size_t>(accuracy)];
}
}
