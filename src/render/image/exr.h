// Writes OpenEXR images: encoded in memory, then written atomically.
//
// Channels: R G B A (premultiplied), Z, surface.R/G/B, background.R/G/B, inscatter.R/G/B, light_NAME.R/G/B (in the
// order of tyndall:lights), ambient.R/G/B, emission.R/G/B, multiple.R/G/B, transmittance.T (with .R/G/B if the scene's
// fog is chromatic), validity.T, Variance.R/G/B (of the mean RGB), half_a.R/G/B, half_b.R/G/B (RGB of the even and odd
// batches). Half floats, clamped to ±65504 (tyndall:clamped counts them), or 32 bit on request; Z (1e10 where there is
// no surface), Variance and the halves are always 32 bit. Rec.709, ZIP, no date and no host: the same input gives the
// same bytes.
#pragma once
#include "base/exr/exr_file.h"
#include "render/frame/layers.h"
#include "scene/camera.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// How an image was made; becomes header attributes.
struct Provenance {
    Camera camera;
    double frame_rate = 24;
    int frame = 0;
    std::map<std::string, std::string> attributes; // "tyndall:mode" -> "march", ...: all text, names up to 31 bytes
};

// Which layers go into the file besides RGBA.
struct ExrOptions {
    std::vector<std::string> layers{"Z", "inscatter", "transmittance"};
    bool full_float = false; // colors as 32 bit instead of half
};

// All layers that a file can hold.
const std::vector<std::string>& layer_names();

// Throws Error (usage), naming a layer that does not exist.
void check_layer_names(const ExrOptions& options);

// Where the pixels lie in the image.
struct ExrWindow {
    ivec2 display{0}, low{0}, size{0};
};

// Floats of an image, `stride` apart.
struct ExrChannel {
    std::string name;
    const float* values;
    size_t stride;
    bool full_float; // else half
};

enum class ExrPacking { none, run_lengths, zip };

// Writes channels of any names. Throws Error (unwritable, internal).
void write_exr_channels(const std::filesystem::path& file, const ExrWindow& window,
                        std::span<const ExrChannel> channels, const Provenance& provenance,
                        ExrPacking packing = ExrPacking::zip);

// Sorted names of the channels that write_exr writes for these lights and fog.
std::vector<std::string> channel_names(const std::vector<std::string>& lights, bool colored_fog,
                                       const ExrOptions& options);

// Throws Error (usage, unwritable, internal).
void write_exr(const std::filesystem::path& file, const Layers& layers, const Provenance& provenance,
               const ExrOptions& options);

// The colors as a file with these options holds them.
Image<vec3> stored_color(const Layers& layers, const ExrOptions& options);

inline constexpr float no_surface_z = 1e10f;
}
