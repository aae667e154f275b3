// An IES file as lights use it: a table that is even in the angles, so that a direction finds its place at once.
#pragma once
#include "base/math.h"

#include <memory>
#include <string>
#include <vector>

namespace tyndall {
struct IesFile;

struct IesProfile {
    std::string content;         // hash of the file
    double peak = 0, lumens = 0; // candela; of all that is sent
    float reach = pi;            // radians off the aim: nothing is sent beyond
    float detail = 0;            // radians over which the light may change
    int rows = 0, columns = 1;   // of vertical angles; of horizontal ones once around, the last as the first
    float first = 0, last = pi;  // vertical angles of the first and the last row, radians
    float rows_per_radian = 1, columns_per_radian = 1;
    std::vector<float> shares; // of the peak: [column · rows + row]
};

// Exact where the angles of the file are multiples of a step down to 0.1 (horizontal 0.5) degrees, as they nearly
// always are; else of such a step. Types A and B are turned into type C.
std::shared_ptr<const IesProfile> make_ies_profile(const IesFile& file, std::string content);

// Share of the peak in a direction (unit), in the axes of candela_at().
double profile_share(const IesProfile& profile, dvec3 direction);
}
