
#include "modes/mode.h"
#include "base/error.h"
#include "base/text.h"
#include "modes/techniques.h"

#include <array>

namespace tyndall {
std::span<const Mode> modes() {
    static const std::array table{
        Mode{"march", "ray march through all fog with shadow rays: the main renderer", Accuracy::single_scattering,
             Surfaces::shared, march_limits, prepare_march},
        Mode{"froxel", "fog light cached in voxels of the view frustum: previews at interactive rates",
             Accuracy::single_scattering, Surfaces::shared, froxel_limits, prepare_froxel, nullptr, true},
        Mode{"shadow-map", "ray march in a fixed number of steps with shadow maps", Accuracy::single_scattering,
             Surfaces::shared, shadow_map_limits, prepare_shadow_map, nullptr, true},
        Mode{"shadow-volume",
             "silhouettes extruded away from the lights; fog integrated exactly where it is lit: no noise",
             Accuracy::even_fog, Surfaces::shared, shadow_volume_limits, prepare_shadow_volume},
        Mode{"cone", "closed forms for the light of spots, points and suns in even fog, without shadows",
             Accuracy::even_fog, Surfaces::shared, cone_limits, prepare_cone, nullptr, true},
        Mode{"billboard", "textured beam cards where light leaks into the scene: a look, not light", Accuracy::look,
             Surfaces::shared, billboard_limits, prepare_billboard},
        Mode{"radial-blur", "brightness smeared away from the lights in the finished picture", Accuracy::look,
             Surfaces::post, radial_blur_limits, prepare_radial_blur, post_radial_blur},
        Mode{"path", "unbiased path tracing of all scattered light: the truth, with noise",
             Accuracy::multiple_scattering, Surfaces::own, path_limits, prepare_path},
    };
    return table;
}

const Mode& find_mode(std::string_view name) {
    std::vector<std::string> names;
    for (const Mode& mode : modes()) {
        if (mode.name == name) return mode;
        names.emplace_back(mode.name);
    }
    fail(ExitCode::usage, "--mode", "no mode '" + printable(name, 40) + "'; there is " + joined(names, ", "));
}

bool honours_style(const Mode& mode) { return mode.surfaces != Surfaces::own; }

bool has_fluence(const Mode& mode) { return mode.prepare == prepare_march || mode.prepare == prepare_froxel; }

bool error_is_noise(const Mode& mode) {
    return mode.surfaces == Surfaces::own && mode.accuracy == Accuracy::multiple_scattering;
}

std::string_view name_of(Accuracy accuracy) {
    constexpr std::string_view names[] = {"look", "even fog", "single scattering", "multiple scattering"};
    return names[static_cast<size_t>(accuracy)];
}

std::string_view name_of(Severity severity) {
    constexpr std::string_view names[] = {"info", "degraded", "wrong"};
    return names[static_cast<size_t>(severity)];
}
}
