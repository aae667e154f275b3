// How long the interface takes, and how soon pictures come.
#pragma once
#include "viewer/painting/render_thread.h"

#include <string>
#include <vector>

namespace tyndall {
struct InterfaceTimes {
    std::vector<double> interface, gl; // seconds of each frame, without and with nothing but GL; swapping apart
    double first_picture = -1;         // seconds after the start
    double seconds = 0;                // in all
};

// For people; one line each on the interface, GL and pictures.
std::string times_text(const InterfaceTimes& times, const PictureCounts& counts);
}
