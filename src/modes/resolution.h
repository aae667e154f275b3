// Fog at a share of the resolution.
#pragma once

namespace tyndall {
// How large a picture a technique computes inside, along each side; its pixels are then spread over the whole one.
enum class Resolution { full, half, third, quarter };
}
