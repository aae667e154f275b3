// Scene file text for edits, and for the defaults of a bare volume or glTF.
#pragma once
#include "scene/scene.h"

namespace tyndall {
// The shortest decimal text that gives the same float when parsed as double and rounded; finite numbers only.
std::string json_number(float value);
std::string list_text(vec3 value);

std::string camera_text(const CameraSource& camera); // one without a node
std::string sun_text(const LightSource& sun);

// The text of a scene file for a bare volume: the volume, a sun, some ambient light and a camera that frames it. Throws
// Error (unreadable, refused).
std::string volume_scene_text(const std::filesystem::path& vdb);
}
