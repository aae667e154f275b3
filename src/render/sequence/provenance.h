// How a frame was made: a hash to compare and attributes to keep.
#pragma once
#include "base/io/file_hashes.h"
#include "render/sequence/job.h"

#include <map>
#include <string>

namespace tyndall {
struct Scene;
struct View;

// Hashes the volumes of a frame's media. Throws Error (unreadable).
void hash_fog(const Scene& scene, const RenderRequest& request, int frame, FileHashes& files);

// One hash over everything the pixels and header of a frame depend on: contents of the scene's files and of the frame's
// fog, the lights as loaded, mode, settings, size, crop, camera, seed, layers, instruction set and program version.
// Directories do not count. Throws Error (unreadable).
std::string frame_hash(const Scene& scene, const RenderRequest& request, const RenderPlan& plan, const View& view,
                       FileHashes& files);

// The shell command that renders all requested frames, without anything that is in no file: unsaved edits, a camera
// moved by hand.
std::string command_line(const RenderRequest& request);

// Attributes to render the frame again; files are named without the folders above those of scene and output.
Provenance provenance_of(const Scene& scene, const RenderRequest& request, const RenderPlan& plan, const View& view,
                         const std::string& hash, const FrameStats& stats);

// Reads samples, noise and the number of non-finite samples back from an image's attributes.
void read_noise(const std::map<std::string, std::string>& attributes, FrameStats& stats);
}
