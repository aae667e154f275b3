// A medium's density, looked at: a slice across it or what lies behind each other, with what is known of its grid.
#pragma once
#include "viewer/painting/request.h"

namespace tyndall {
struct Snapshot;

struct VolumePicture {
    uint64_t revision = 0; // of the request it is of
    VolumeQuestion question;
    int frame = 1;
    bool quick = false;                                     // made while things moved: files were not looked through
    std::string medium;                                     // that is shown; empty = the scene has none now
    std::vector<std::pair<std::string, std::string>> facts; // name and value, of its grid
    Image<glm::u8vec4> codes;                               // heat_color() of the density over `high`
    double high = 1;                                        // density of white,
    double extinction = 0;                                  // and 1/m at density 1
    int right = 0, up = 1;                                  // world axes of the picture
    Box box;                                                // world box that is shown
    double place = 0;                                       // of the slice on its axis, metres
    std::string remark;                                     // why there is nothing to see
};

// Files that were looked through, so that it is done once.
struct KnownVolumes {
    std::string key;
    std::vector<std::pair<std::string, std::string>> facts;
};

// Slices lie at `position` between the borders of the box; maximum and mean are along the axis. Cells of the picture
// are as large as voxels, but no more than 256 along a side. Throws Error when a file cannot be read.
std::shared_ptr<const VolumePicture> volume_picture(const Request& request, const Snapshot& snapshot,
                                                    KnownVolumes& known);
}
