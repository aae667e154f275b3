// The scene as its files describe it: plain data, any value possibly animated, without render settings.
#pragma once
#include "base/io/file_sequence.h"
#include "scene/background_kind.h"
#include "scene/keyed.h"
#include "scene/lights/gobo.h"
#include "scene/lights/light_kind.h"
#include "scene/load_options.h"
#include "scene/mesh.h"
#include "scene/phase_source.h"
#include "scene/shutter.h"
#include "volume/emission/blackbody.h"
#include "volume/recipe/recipe.h"
#include "volume/value_map.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tyndall {
struct IesProfile;

// A node of the hierarchy; parents come before their children.
struct Node {
    std::string name;
    int parent = -1;
    Keyed<vec3> translation{vec3(0)};
    Keyed<quat> rotation{quat(1, 0, 0, 0)};
    Keyed<vec3> scale{vec3(1)};
    std::optional<mat4> matrix; // replaces the three above
    dvec3 remainder{0};         // what rounding the position in the file to float removed
};

// The nodes that deform a mesh, each with its inverse bind matrix.
struct Skin {
    std::vector<int> joints;
    std::vector<mat4> inverse_bind;
};

struct Instance {
    int node = -1, mesh = -1;
    bool casts_shadows = true; // else it casts no shadows; it is still visible and lit
    bool matte = false;        // a holdout for what is behind it; it still emits light and casts shadows
    int skin = -1;             // whose joints replace its node's transform; -1 = none
    std::vector<Keyed<float>> target_weights{}; // of the mesh's morph targets
    std::vector<bool> lit{}, casters{};         // of the light that it emits, as those of a LightSource
};

struct CameraSource {
    std::string name;
    int node = -1; // glTF camera: looks along the node's -Z ...
    Keyed<vec3> position{vec3(0, 1, 4)}, target{vec3(0)}, up{vec3(0, 1, 0)}; // ... else these
    Keyed<float> vertical_fov{0.8f};                                         // radians
    Keyed<float> ortho_height{0.0f};                                         // meters; 0 = perspective
    float near = 0.01f, far = infinity;
    Keyed<float> aperture{0.0f};       // radius of the lens, meters; 0 = a pinhole
    std::optional<Keyed<float>> focus; // meters along the viewing direction; none: the target's distance
    int blades = 0;
    Keyed<float> blade_rotation{0.0f}; // radians
    Shutter shutter;
    std::string entry; // JSON pointer of its entry in the scene file; empty = none
};

inline bool is_orthographic(const CameraSource& camera) { return camera.ortho_height.at(0) > 0; }

// The unit of a light's intensity.
enum class LightUnit {
    native,  // candela (point, spot), lux (sun) or nit (rectangle, disc, sphere)
    candela, // of the whole face, along its axis
    lumen,   // total flux
    watt,    // times an efficacy: lumens, or lux for a sun
    profile  // factor on the candela of its IES file
};

struct GoboSource {
    std::shared_ptr<const Gobo> still; // null: a sequence with one image per frame
    FileSequence sequence;
    ColorSpace space = ColorSpace::srgb;
    Keyed<float> rotation{0.0f}; // radians, counterclockwise as seen from the light
    Keyed<float> scale{1.0f};
};

struct LightSource {
    std::string name;
    LightKind kind = LightKind::point;
    int node = -1;                                            // glTF light: at the node's origin, along its -Z ...
    Keyed<vec3> position{vec3(0)}, direction{vec3(0, -1, 0)}; // ... else these; any length above 0
    Keyed<vec3> color{vec3(1)};
    Keyed<float> intensity{1.0f}; // in the unit below
    LightUnit unit = LightUnit::native;
    float efficacy = 0;             // lumens per watt, for LightUnit::watt
    bool whole_sphere = false;      // a spot's lumens are spread over the full sphere, and only its cone is emitted
    Keyed<float> exposure{0.0f};    // stops
    Keyed<float> temperature{0.0f}; // kelvin, multiplies the color; 0 = none
    Keyed<vec3> up{vec3(0, 1, 0)};  // of rectangle, profile and gobo, if the light has no node
    Keyed<float> profile_rotation{0.0f};       // radians, counterclockwise as seen from the light
    std::shared_ptr<const IesProfile> profile; // null = none
    std::optional<GoboSource> gobo;
    Keyed<float> volume_scale{1.0f}, surface_scale{1.0f};
    Keyed<float> inner_cone{0.0f}, outer_cone{pi / 4}; // radians, half angles
    Keyed<float> radius{0.0f}, angle{0.0f};
    Keyed<float> width{1.0f}, height{1.0f}; // rectangle, meters
    bool two_sided = false;                 // rectangle, disc
    bool visible = true;                    // rectangle, disc, sphere: the camera sees it
    Keyed<float> range{infinity};           // meters
    bool shadows = true;
    std::vector<bool> lit, casters; // per instance: whether it is lit by the light, and casts its shadows; empty = all
    std::optional<Keyed<vec3>> target; // from which `direction` was computed
    std::string entry;                 // as in CameraSource
};

enum class MediumKind { homogeneous, height, noise, vdb };

// One property of a medium, in a grid of a file or sequence.
struct GridSource {
    FileSequence sequence;
    std::vector<std::string> grids; // one name, or three for red, green and blue
    ValueMap map;

    std::string text() const; // identifies grids and map in cache keys
};

// Velocities that move a medium from files while the shutter is open: in the file's length units per second or frame,
// times `scale`.
struct VelocitySource {
    GridSource grid; // one grid of vectors, or three of scalars
    float scale = 1;
    bool per_frame = false;
};

// How a temperature becomes emission per meter: its blackbody color and brightness times `scale` and `tint`, and with
// `by_absorption` also in proportion to the absorption coefficient.
struct BlackbodySource {
    BlackbodyKind kind = BlackbodyKind::kelvin;
    Keyed<float> scale{1.0f};
    Keyed<vec3> tint{vec3(1)};
    float intensity = 1; // cycles only
    bool by_absorption = false;
};

struct MediumSource {
    std::string name;
    MediumKind kind = MediumKind::homogeneous;
    Keyed<float> extinction{0.1f}, g{0.0f};        // g: used if the phase function takes the medium's
    std::optional<Keyed<vec3>> channel_extinction; // if the channels differ; `extinction` is their mean
    Keyed<vec3> albedo{vec3(0.95f)}, emission{vec3(0)};
    PhaseSource phase;
    Box bounds = everywhere(); // homogeneous, height: in the medium's own space
    Keyed<vec3> translation{vec3(0)}, scale{vec3(1)};
    Keyed<vec3> rotate{vec3(0)}; // degrees about X, then Y, then Z, from which `rotation` is computed
    Keyed<quat> rotation{quat(1, 0, 0, 0)};
    Keyed<float> height_base{0.0f}, height_falloff{1.0f};
    std::optional<FogRecipe> recipe;                      // noise
    float voxel_size = 0;                                 // noise: replaces the recipe's, meters
    bool z_up = false;                                    // noise, vdb: the volume's z is up, its -y is the scene's z
    FileSequence sequence;                                // vdb: of the density
    std::string density_grid;                             // vdb: its name; empty = chosen automatically
    ValueMap density_map;                                 // vdb
    std::optional<GridSource> albedo_grid, emission_grid; // vdb: factors on `albedo`, and on `emission`
    std::optional<GridSource> temperature, flame;         // vdb: kelvin, and a factor on the resulting emission
    std::optional<BlackbodySource> blackbody;             // with a temperature, or a recipe's fire
    std::optional<VelocitySource> velocity;               // vdb; excludes `blends`
    bool blends = false;                                  // vdb: files are blended while the shutter is open
    std::string entry;                                    // as in CameraSource
};

struct Background {
    bool stated = false; // the scene states a background, even if black
    BackgroundKind kind = BackgroundKind::color;
    Keyed<vec3> color{vec3(0)};                   // color; horizon of the sky
    Keyed<vec3> zenith{vec3(0)}, ground{vec3(0)}; // sky
    bool own_ground = false;                      // else the ground is the horizon's color
    std::shared_ptr<const Image<vec3>> image;     // image
    bool lat_long = false;                        // wrapped around the scene; else a plate behind the image
    Keyed<float> intensity{1.0f};
    Keyed<float> exposure{0.0f}; // stops
    Keyed<float> rotation{0.0f}; // radians about Y, lat-long
};

// An environment light.
struct EnvironmentSource {
    std::string name;
    Background map;                               // its own, or the scene's background
    Keyed<float> intensity{1.0f}, exposure{0.0f}; // factor on the map, and stops
    Keyed<float> volume_scale{1.0f}, surface_scale{1.0f};
    bool shadows = true;
    std::vector<bool> casters, lit; // as those of a LightSource
};

// A hand-placed beam card for the billboard technique.
struct Billboard {
    std::string name, light;
    vec3 from{0}, to{0, -1, 0};
    float width_from = 0.1f, width_to = 0.5f;
    vec3 tint{1};
    float intensity = 1;
};

// A file that a scene was read from, as it was at that time.
struct InputFile {
    std::filesystem::path path;
    std::string hash; // of its content
};

struct Scene {
    std::filesystem::path file;
    dvec3 origin{0}; // world position that all others are relative to; 0 unless the scene is far from 0
    double frame_rate = 24;
    int first_frame = 1, last_frame = 1; // the default of --frames
    ivec2 resolution{640, 360};
    Keyed<float> exposure{0.0f}; // stops, for PNGs, ...
    bool own_exposure = false;   // ... if the scene states one
    std::vector<Node> nodes;
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<Instance> instances;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<std::string> animations; // names of the glTF's, played or not
    std::vector<CameraSource> cameras;
    int camera = 0; // the default one
    std::vector<LightSource> lights;
    Keyed<vec3> ambient{vec3(0)}; // uniform radiance from everywhere, unshadowed
    std::vector<MediumSource> media;
    Background background;
    std::optional<EnvironmentSource> environment;
    std::vector<Billboard> billboards;
    std::vector<InputFile> inputs;     // every file read, for hashes and reloading
    std::vector<std::string> warnings; // one line each, without duplicates
};

// Reads a scene file, or a bare .gltf, .glb or .vdb, whose missing parts get defaults, with warnings. Throws Error.
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

// A scene from the text of a scene file that need not exist: paths in it are relative to where `file` would be.
Scene load_scene_text(std::string_view text, const std::filesystem::path& file, const LoadOptions& options = {});

// Local to world, and the same relative to the scene's origin. Node -1 is the world.
dmat4 world_matrix(const Scene& scene, int node, double seconds);
mat4 node_matrix(const Scene& scene, int node, double seconds);

// The name of an instance's node, else of its mesh, else "mesh 3".
std::string name_of_instance(const Scene& scene, int instance);

// Whether a light is off because its node has a scale of 0 along the light's direction: a usual way to hide things.
bool is_hidden(const Scene& scene, const LightSource& light, double seconds);

// Whether a node (-1 = none) or one of its ancestors is animated.
bool is_moving(const Scene& scene, int node);

// Why a medium cannot have this scale; null if it can.
const char* scale_problem(vec3 scale);
mat4 medium_matrix(const MediumSource& medium, double seconds); // from the medium's own space to the world

// Whether it emits light at any time.
bool emits_light(const MediumSource& medium);

// Bounds of every instance at a time, and of every medium whose extent is known without opening volumes.
Box scene_bounds(const Scene& scene, double seconds);
}
