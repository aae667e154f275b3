// How to render: plain structs with defaults, and the same fields as named rows for --set, help, the viewer and
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
    int lamp_samples = 16; // most times as many rays where a local light is seen
    int edge_samples = 4;  // most times as many rays where the picture changes from pixel to pixel
};

inline constexpr int all_orders = 65536; // ends paths that nothing else ends

struct PathSettings {
    int orders = all_orders; // most scatterings of light, in fog or on surfaces
};

// Settings of every technique, and what they share. A technique's own are found by their type: settings.of<T>() is
// T() until something was set.
struct Settings {
    PixelSettings pixel;
    TermSettings terms;
    StyleSettings style;
    MarchSettings march;
    FluenceSettings fluence; // of march and froxel
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
    std::vector<std::string> choices{}; // of an enumeration or switch; empty for a number
    double low = 0, high = 0;           // range of a number
    bool integer = false;
    bool advanced = false; // most users leave it alone
    std::function<std::string(const Settings&)> get{};
    std::function<void(Settings&, std::string_view)> set{}; // throws Error (usage)
    int parts = 1;                                          // numbers of a value; 3 = a colour
};
const std::vector<SettingRow>& setting_rows();

// "march.step_depth=0.1". Throws Error (usage): an unknown row names the nearest one.
void apply_setting(Settings& settings, std::string_view assignment);

// Names of the modes that are taken unless said otherwise (modes/mode.h): for pictures, and for those in between while
// things move.
std::string main_mode_name();
std::string interactive_mode_name();

std::string_view name_of(Quality quality);
Quality quality_named(std::string_view name); // throws Error (usage)
}
