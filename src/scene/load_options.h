// Options for reading scene files.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tyndall {
enum class LightUnits { spec, unitless, raw };
inline const std::vector<std::string> light_unit_names{"spec", "unitless", "raw"};

struct LoadOptions {
    // Units of the glTF's lights: candela and lux; Blender's "unitless" (683 lm/W missing); Blender's "raw" watts
    // (points and spots also spread over the sphere, 683 / 4 pi).
    LightUnits light_units = LightUnits::spec;
    std::optional<std::vector<std::string>> animations{}; // names of those of the glTF to play; none: all
    size_t texture_bytes = size_t{1} << 30; // the most that all textures of a glTF may take; smaller in tests
};
}
