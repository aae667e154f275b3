// Validates the structure of a glTF document: every member that is used has the right type and range, and every index
// refers to an existing element. Works on the raw JSON, before any library reads it.
#pragma once
#include "base/json/json.h"

namespace tyndall {
// Throws Error (refused) naming file and JSON pointer.
void check_gltf_schema(const Json& document, std::string_view file);

// Checks requirements of members on each other; call after check_gltf_schema(). Throws Error (refused).
void check_gltf_needs(const Json& document, std::string_view file);

// The array of a collection ("nodes"; "lights" of KHR_lights_punctual, "profiles" of EXT_lights_ies), or null.
const Json* gltf_collection(const Json& document, std::string_view name);
}
