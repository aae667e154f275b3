// An IES file as lights use it: a table with even steps of the angles, for constant-time lookup.
#pragma once
#include "base/math.h"

#include <memory>
#include <string>
#include <vector>

namespace tyndall {
struct IesFile;

struct IesProfile {
    std::string content;         // hash of the file
    std::string loss;            // what the table loses of the file, one line; empty if nothing to speak of
    double peak = 0, lumens = 0; // candela of the table; total flux, the same as the file's
    float reach = pi;            // radians from the aim beyond which no light is emitted
    float detail = 0;            // radians over which the light may change
    int rows = 0, columns = 1;   // vertical angles; horizontal angles once around, the last the same as the first
    float first = 0, last = pi;  // vertical angles of the first and the last row, radians
    float rows_per_radian = 1, columns_per_radian = 1;
    std::vector<float> shares; // fractions of the peak: [column · rows + row]
};

// Exact if the file's angles are multiples of a step of 0.01 (horizontal 0.1) degrees, or 0.1 (0.5) if there are very
// many, as they nearly always are; else resampled, with the file's lumens. Types A and B are converted to type C.
std::shared_ptr<const IesProfile> make_ies_profile(const IesFile& file, std::string content);

// Intensity in a unit direction as a fraction of the peak, in the axes of candela_at().
double profile_factor(const IesProfile& profile, dvec3 direction);
}
