// IES profiles and gobos of the lights of a frame.
#pragma once
#include "base/io/file_sequence.h"
#include "trace/moment.h"

#include "base/math.h"

namespace tyndall {
struct Light;
struct LightSource;
struct Snapshot;

// Gives a light, whose place and cone are known, its filter if it has one; `up` is that of the light. A point light
// whose profile sends nothing backwards becomes a spot: what ends at its cone is then never asked for beyond. Pictures
// that `previous` (may be null) has are not read again. Throws Error.
void add_filter(const LightSource& source, Moment moment, vec3 up, MissingFrame missing, const Snapshot* previous,
                Light& light);
}
