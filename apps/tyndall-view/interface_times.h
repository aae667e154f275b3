// Timings of the interface and of the first image.
#pragma once
#include "viewer/painting/render_thread.h"

#include <string>
#include <vector>

namespace tyndall {
struct InterfaceTimes {
    std::vector<double> interface, gl; // seconds per frame, before GL and in GL; neither includes the buffer swap
    double first_picture = -1;         // seconds after the start
    double seconds = 0;                // total run time
};

// Readable text: one line each on the interface, GL and images.
std::string times_text(const InterfaceTimes& times, const PictureCounts& counts);
}
