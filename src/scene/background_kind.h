// What lies behind everything.
#pragma once

namespace tyndall {
enum class BackgroundKind { color, sky, image };
}
