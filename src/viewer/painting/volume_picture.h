// An image of a medium's density: a slice or a projection, with facts about its grid.
#pragma once
#include "viewer/painting/request.h"

namespace tyndall {
struct Snapshot;

struct VolumePicture {
    uint64_t revision = 0; // of its request
    VolumeRequest question;
    int frame = 1;
    bool quick = false;                                     // made while things moved: files were not read
    std::string medium;                                     // that is shown; empty = the scene has none at this time
    std::vector<std::pair<std::string, std::string>> facts; // name and value, of its grid
    Image<glm::u8vec4> codes;                               // heat_color() of the density over `high`
    double high = 1;                                        // the density shown as white,
    double extinction = 0;                                  // and the extinction at density 1, 1/m
    int right = 0, up = 1;                                  // world axes of the picture
    Box box;                                                // the world-space box that is shown
    double place = 0;                                       // of the slice on its axis, meters
    std::string remark;                                     // why nothing is shown
};

// Facts about the last file read, so that it is read only once.
struct KnownVolumes {
    std::string key;
    std::vector<std::pair<std::string, std::string>> facts;
};

// Slices lie at `position` between the sides of the box; maximum and mean are along the axis. Cells of the image are as
// large as voxels, but at most 256 along a side. Throws Error if a file cannot be read.
std::shared_ptr<const VolumePicture> volume_picture(const Request& request, const Snapshot& snapshot,
                                                    KnownVolumes& known);
}
