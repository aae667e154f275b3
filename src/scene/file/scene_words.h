// What a scene file would say, as text: of things made up for a file that is not one, and of edits.
#pragma once
#include "scene/scene.h"

namespace tyndall {
// The shortest decimal digits that a reader by way of double turns into these very bits; finite numbers only.
std::string json_number(float value);
std::string list_text(vec3 value);

std::string camera_text(const CameraSource& camera); // one without a node
std::string sun_text(const LightSource& sun);

// The text of a scene file beside a bare volume: the volume, a sun, some ambient light, a camera that frames it. Throws
// Error (unreadable, refused).
std::string volume_scene_text(const std::filesystem::path& vdb);
}
