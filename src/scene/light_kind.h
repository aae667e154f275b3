// Kinds of lights, as in KHR_lights_punctual.
#pragma once

namespace tyndall {
enum class LightKind { point, spot, sun };
}
