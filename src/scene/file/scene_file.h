// The parts of a scene file, read one by one into a Scene. Each throws Error (refused, unreadable) naming file and
// field.
#pragma once
#include "scene/file/values.h"
#include "scene/scene.h"

#include <functional>

namespace tyndall {
void read_cameras(const Field& root, Scene& scene);
void read_objects(const Field& root, Scene& scene); // after the glTF
void read_lights(const Field& root, Scene& scene);  // after the glTF: entries may change its lights
// The phase function of a medium. Also checks the medium's g against it.
void read_phase(const Field& medium_field, MediumSource& medium, Scene& scene);

void read_media(const Field& root, Scene& scene);
// A color, a sky or a lat-long image.
void read_map(const Field& field, Scene& scene, Background& map);
void read_background(const Field& root, Scene& scene);

bool is_environment(const Field& light);                // `light`: an entry of "lights"
void read_environment(const Field& root, Scene& scene); // after lights and background
void read_billboards(const Field& root, Scene& scene);  // after the lights: each names one

// The instances of an object: of a node and its descendants, or else of a mesh; empty if the name is neither.
std::vector<int> instances_named(const Scene& scene, const std::string& name);

// Reads a light link: per instance, whether it is included.
std::vector<bool> read_link(const Field& field, const Scene& scene);

// Whether the inner cone never exceeds the outer one, at their keys.
bool cones_fit(const LightSource& light);

// The path a field gives, relative to the scene file. Throws Error (unreadable) when there is no such regular file.
std::filesystem::path named_file(const Field& field, const Scene& scene);

// The profile of an IES file; its notes become warnings that name `where`.
inline constexpr uint64_t largest_ies_file = uint64_t{16} << 20; // bytes
std::shared_ptr<const IesProfile> read_profile(std::string_view bytes, std::string_view where, Scene& scene);

// Reads profile, gobo and units of a light.
void read_light_power(const Field& field, LightSource& light); // after its profile
void read_profile(const Field& field, Scene& scene, LightSource& light);
void read_gobo(const Field& field, Scene& scene, LightSource& light);

// How a sequence continues before its first and after its last file.
SequenceMode sequence_mode_named(std::string_view name);

// Runs `read` on a file that `field` names; its errors then name the field as well.
void with_location(const Field& field, const std::function<void()>& read);

void warn(Scene& scene, std::string_view text); // one line, without duplicates
void add_input(Scene& scene, const std::filesystem::path& path, std::string_view content); // each file once
}
