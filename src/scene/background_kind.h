// The kinds of background behind the scene.
#pragma once

namespace tyndall {
enum class BackgroundKind { color, sky, image };
}
