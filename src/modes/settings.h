// How to render: plain structs with defaults, and the same fields as named rows for --set, help, the viewer and file
// headers.
#pragma once
#include "base/math.h"
#include "integrate/march_steps.h"
#include "integrate/style.h"
#include "integrate/terms.h"
#include "trace/fluence/settings.h"
#include "trace/sampling/jitter.h"
#include "trace/sampling/pixel_filter.h"
#include "trace/transmittance/light_transmittance.h"

#include <any>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
struct PixelSettings {
    int samples = 4; // camera rays per pixel
    PixelFilter filter = PixelFilter::blackman_harris;
    float filter_radius = 1; // pixels
    Jitter jitter = Jitter::interleaved;
    int lamp_samples = 16; // maximum factor on samples where a local light is in view
    int edge_samples = 4;  // maximum factor on samples where the image changes between pixels
};

inline constexpr int all_orders = 65536; // caps the length of paths that nothing else terminates

struct PathSettings {
    int orders = all_orders; // maximum number of scattering events, in fog or on surfaces
};

// Settings of all techniques, shared ones first. A technique's own settings are stored by type: settings.of<T>() is a
// default T() until it is set.
struct Settings {
    PixelSettings pixel;
    TermSettings terms;
    StyleSettings style;
    MarchSettings march;
    FluenceSettings fluence; // used by march and froxel
    PathSettings path;

    template<class T> T& of() {
        for (std::any& one : own)
            if (T* found = std::any_cast<T>(&one)) return *found;
        return *std::any_cast<T>(&own.emplace_back(T()));
    }
    template<class T> const T& of() const {
        static const T usual;
        for (const std::any& one : own)
            if (const T* found = std::any_cast<T>(&one)) return *found;
        return usual;
    }

private:
    std::vector<std::any> own;
};

enum class Quality { draft, preview, final, reference };
Settings settings_for(Quality quality);

// One field by name: march.step_depth, its unit, range or choices, and what it does.
struct SettingRow {
    std::string name, unit, doc;
    std::vector<std::string> choices{}; // for an enumeration or switch; empty for a number
    double low = 0, high = 0;           // range, for a number
    bool integer = false;
    bool advanced = false; // most users can ignore it
    std::function<std::string(const Settings&)> get{};
    std::function<void(Settings&, std::string_view)> set{}; // throws Error (usage)
    int parts = 1;                                          // numbers per value; 3 = a color
};
const std::vector<SettingRow>& setting_rows();

// The row of a name. Throws Error (usage) at `where`, suggesting the nearest name.
const SettingRow& find_row(std::string_view name, std::string_view where = "--set");

// Whether all rows are equal.
bool same_settings(const Settings& a, const Settings& b);

// Applies "march.step_depth=0.1". Throws Error (usage).
void apply_setting(Settings& settings, std::string_view assignment);

// Names of the default modes (modes/mode.h): for final images, and for interactive previews.
std::string main_mode_name();
std::string interactive_mode_name();

std::string_view name_of(Quality quality);
Quality quality_named(std::string_view name); // throws Error (usage)
}
