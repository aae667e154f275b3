// Saves an image of the viewer to the same file that tyndall render writes.
#pragma once
#include "base/error.h"
#include "scene/load_options.h"
#include "scene/scene.h"
#include "viewer/painting/request.h"

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

namespace tyndall {
struct Snapshot;

struct SaveJob {
    std::filesystem::path file; // .exr or .png
    Request request;
    std::string camera; // name for the header; empty = the scene's
    Quality quality = Quality::preview;
    std::string isa;
    LightUnits light_units = LightUnits::spec;
    std::vector<InputFile> inputs; // the current scene files, which saving changes; empty = as loaded
    std::string unsaved;           // edits that the scene's files do not have; noted in the header
};

struct SaveResult {
    std::filesystem::path file;
    double seconds = 0;
    std::string error; // empty = written
    ExitCode code = ExitCode::ok;
};

// Renders all samples of the settings, independent of previous images, and writes the file: bit for bit that of tyndall
// render for the same scene, frame, camera, size, mode, settings and seed, except for `unsaved`. Static data may be
// shared with `previous` if it is of the same scene. Throws Error.
void save_picture(const SaveJob& job, const Snapshot* previous, std::atomic<bool>& cancel,
                  const std::function<void(double)>& progress);
}
