// IES profiles and gobos of the lights of a frame.
#pragma once
#include "base/io/file_sequence.h"
#include "trace/moment.h"

#include "base/math.h"

#include <string>
#include <vector>

namespace tyndall {
struct Light;
struct LightSource;
struct Snapshot;

// Sets the filter of a light, if it has one; the light's position and cone must be set, `up` is its up vector. A point
// light whose profile emits nothing backward becomes a spot, so that nothing beyond its cone is evaluated. Reuses
// images that `previous` (may be null) has. Notes once what images of a sequence lose. Throws Error.
void add_filter(const LightSource& source, Moment moment, vec3 up, MissingFrame missing, const Snapshot* previous,
                std::vector<std::string>& notes, Light& light);
}
