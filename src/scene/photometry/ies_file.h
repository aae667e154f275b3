// Photometric files of lamps and luminaires: ANSI/IES LM-63 of 1986, 1991, 1995, 2002 and 2019.
#pragma once
#include "base/math.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tyndall {
enum class Photometry { type_c = 1, type_b, type_a };

struct IesFile {
    std::string standard = "LM-63-1986"; // the default for a file whose first line names no standard
    std::vector<std::pair<std::string, std::string>> keywords;
    std::string tilt; // NONE, INCLUDE or the name of a file
    Interval<double> tilt_factors{1, 1};
    Photometry type = Photometry::type_c;
    double lamps = 1, lumens_per_lamp = -1; // below 0: absolute photometry
    double multiplier = 1, ballast = 1;     // candela multiplier and ballast factor; `candela` includes both
    double generation = 0;                  // LM-63-2019's code of the file generation type, 0 = not stated
    double watts = 0;
    dvec3 size{0};                            // width, length, height of the opening, meters; below 0: round
    std::vector<double> vertical, horizontal; // degrees, ascending
    std::vector<double> candela;              // [horizontal · vertical.size() + vertical]
    std::vector<std::string> notes;           // what was corrected or ignored, one line each

    bool absolute() const { return lumens_per_lamp < 0; }
    double peak() const;
};

// Throws Error (refused) naming `where` and the line.
IesFile read_ies(std::string_view bytes, std::string_view where);

// Candela in a unit direction: z along the aim, x in the plane of horizontal angle 0 (types A and B: to the right), y
// up. Bilinear in the angles; 0 outside them.
double candela_at(const IesFile& file, dvec3 direction);

// Total flux in lumens: candela, linear in the angles, integrated over the sphere.
double zonal_lumens(const IesFile& file);
}
