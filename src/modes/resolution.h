// Reduced resolution for fog.
#pragma once

namespace tyndall {
// Resolution at which a technique computes fog, along each side, as a fraction of the image's; the result is upsampled.
enum class Resolution { full, half, third, quarter };
}
