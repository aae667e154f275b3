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
    std::string standard = "LM-63-1986"; // what a file without a first line of its own is
    std::vector<std::pair<std::string, std::string>> keywords;
    std::string tilt; // NONE, INCLUDE or the name of a file
    Interval<double> tilt_factors{1, 1};
    Photometry type = Photometry::type_c;
    double lamps = 1, lumens_per_lamp = -1; // below 0: absolute photometry
    double multiplier = 1, ballast = 1;     // of candela and of the ballast; both are in `candela`
    double generation = 0;                  // LM-63-2019's code of how the file was made, 0 = not said
    double watts = 0;
    dvec3 size{0};                            // width, length, height of the opening, metres; below 0: round
    std::vector<double> vertical, horizontal; // degrees, ascending
    std::vector<double> candela;              // [horizontal · vertical.size() + vertical]
    std::vector<std::string> notes;           // what was mended or left out, a line each

    bool absolute() const { return lumens_per_lamp < 0; }
    double peak() const;
};

// Throws Error (refused) naming `where` and the line.
IesFile read_ies(std::string_view bytes, std::string_view where);

// In a direction (unit): z along the aim, x in the plane of horizontal angle 0 (types A and B: to the right), y up.
// Bilinear in the angles; 0 beyond them.
double candela_at(const IesFile& file, dvec3 direction);

// All light that is sent: candela linear in the angles, integrated over the sphere.
double zonal_lumens(const IesFile& file);
}
