// What the files say: plain data, every number possibly animated. How to render is not in here.
#pragma once
#include "base/io/file_sequence.h"
#include "scene/background_kind.h"
#include "scene/gobo.h"
#include "scene/keyed.h"
#include "scene/light_kind.h"
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

// A place in the hierarchy; parents stand before their children.
struct Node {
    std::string name;
    int parent = -1;
    Keyed<vec3> translation{vec3(0)};
    Keyed<quat> rotation{quat(1, 0, 0, 0)};
    Keyed<vec3> scale{vec3(1)};
    std::optional<mat4> matrix; // instead of the three
    dvec3 remainder{0};         // of the place in the file, beyond what floats hold
};

// Nodes that a mesh follows, and for each the way from the mesh to it where it held the mesh at first.
struct Skin {
    std::vector<int> joints;
    std::vector<mat4> inverse_bind;
};

struct Instance {
    int node = -1, mesh = -1;
    bool casts_shadows = true;                  // else it shadows no light; it is seen and lit as ever
    bool matte = false;                         // holds out what is behind it; it lights and shadows as ever
    int skin = -1;                              // whose joints place it instead of its node; -1 = none
    std::vector<Keyed<float>> target_weights{}; // of the mesh's morph targets
};

struct CameraSource {
    std::string name;
    int node = -1; // glTF camera: looks along the node's -Z ...
    Keyed<vec3> position{vec3(0, 1, 4)}, target{vec3(0)}, up{vec3(0, 1, 0)}; // ... else these
    Keyed<float> vertical_fov{0.8f};                                         // radians
    float ortho_height = 0, near = 0.01f, far = infinity;
    Keyed<float> aperture{0.0f};       // radius of the lens, metres; 0 = a pinhole
    std::optional<Keyed<float>> focus; // metres along the viewing direction; none: as far as the target
    int blades = 0;
    Keyed<float> blade_turn{0.0f}; // radians
    Shutter shutter;
    std::string entry; // JSON pointer of what the scene file says of it; empty = nothing
};

// What the number of a light's intensity means.
enum class LightUnit {
    native,  // candela (point, spot), lux (sun) or nit (rectangle, disc, sphere)
    candela, // of the whole face, seen along its axis
    lumen,   // of all the light
    watt,    // times an efficacy: lumens, or lux of a sun
    profile  // the candela of its IES file, times this
};

struct GoboSource {
    std::shared_ptr<const Gobo> still; // null: one of a sequence for every frame
    FileSequence sequence;
    ColorSpace space = ColorSpace::srgb;
    Keyed<float> turn{0.0f}; // radians, counterclockwise as seen from the light
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
    float efficacy = 0;              // lumens per watt, of watts
    bool whole_sphere = false;       // a spot's lumens are spread over the sphere, and most do not leave its cone
    Keyed<float> exposure{0.0f};     // stops
    Keyed<float> temperature{0.0f};  // kelvin, multiplies the colour; 0 = none
    Keyed<vec3> up{vec3(0, 1, 0)};   // of rectangle, profile and gobo, where the light has no node
    Keyed<float> profile_turn{0.0f}; // radians, counterclockwise as seen from the light
    std::shared_ptr<const IesProfile> profile; // null = none
    std::optional<GoboSource> gobo;
    Keyed<float> volume_scale{1.0f}, surface_scale{1.0f};
    Keyed<float> inner_cone{0.0f}, outer_cone{pi / 4}; // radians, half angles
    Keyed<float> radius{0.0f}, angle{0.0f};
    Keyed<float> width{1.0f}, height{1.0f}; // rectangle, metres
    bool two_sided = false;                 // rectangle, disc
    bool visible = true;                    // rectangle, disc, sphere: the camera sees it
    float range = infinity;
    bool shadows = true;
    std::vector<bool> lit, casters;    // of each instance: whether it is lit by it, and shadows it; empty = all
    std::optional<Keyed<vec3>> target; // what `direction` was made from
    std::string entry;                 // as of a camera
};

enum class MediumKind { homogeneous, height, noise, vdb };

// One property of fog, in a grid of a file or sequence.
struct GridSource {
    FileSequence sequence;
    std::vector<std::string> grids; // a name, or those of red, green and blue
    ValueMap map;
};

// Velocities that move fog of files while the shutter is open: lengths of the file per second or frame, times `scale`.
struct VelocitySource {
    GridSource grid; // one of vectors, or three
    float scale = 1;
    bool per_frame = false;
};

// How a temperature becomes light. Times `scale` and `tint` it is emitted per metre; in proportion to what the fog
// absorbs where `by_absorption` says so.
struct BlackbodySource {
    BlackbodyKind kind = BlackbodyKind::kelvin;
    Keyed<float> scale{1.0f};
    Keyed<vec3> tint{vec3(1)};
    float intensity = 1; // cycles
    bool by_absorption = false;
};

struct MediumSource {
    std::string name;
    MediumKind kind = MediumKind::homogeneous;
    Keyed<float> extinction{0.1f}, g{0.0f};        // g: where the phase function takes that of the medium
    std::optional<Keyed<vec3>> channel_extinction; // where the channels differ; `extinction` is their mean
    Keyed<vec3> albedo{vec3(0.95f)}, emission{vec3(0)};
    PhaseSource phase;
    Box bounds = everywhere(); // homogeneous, height: in the medium's own space
    Keyed<vec3> translation{vec3(0)}, scale{vec3(1)};
    Keyed<vec3> rotate{vec3(0)}; // degrees about X, then Y, then Z: what `rotation` is made from
    Keyed<quat> rotation{quat(1, 0, 0, 0)};
    Keyed<float> height_base{0.0f}, height_falloff{1.0f};
    std::optional<FogRecipe> recipe;                      // noise
    float voxel_size = 0;                                 // noise: instead of the recipe's, metres
    bool z_up = false;                                    // noise, vdb: the volume's z is up, its -y is the scene's z
    FileSequence sequence;                                // vdb: of the density
    std::string density_grid;                             // vdb: its name; empty = the usable one
    ValueMap density_map;                                 // vdb
    std::optional<GridSource> albedo_grid, emission_grid; // vdb: factors on `albedo`, and on `emission`
    std::optional<GridSource> temperature, flame;         // vdb: kelvin, and a factor on what they emit
    std::optional<BlackbodySource> blackbody;             // with a temperature, or a recipe's fire
    std::optional<VelocitySource> velocity;               // vdb; or
    bool blends = false;                                  // vdb: while the shutter is open, from file to file
    std::string entry;                                    // as of a camera
};

struct Background {
    bool stated = false; // the scene says what is there, be it black
    BackgroundKind kind = BackgroundKind::color;
    Keyed<vec3> color{vec3(0)};                   // color; horizon of the sky
    Keyed<vec3> zenith{vec3(0)}, ground{vec3(0)}; // sky
    bool own_ground = false;                      // else it is the horizon's
    std::shared_ptr<const Image<vec3>> image;     // image
    bool lat_long = false;                        // wrapped around the scene; else a plate behind the picture
    Keyed<float> intensity{1.0f};
    Keyed<float> exposure{0.0f}; // stops
    float rotation = 0;          // radians about Y, lat-long
};

// Light from all around.
struct EnvironmentSource {
    std::string name;
    Background map;                               // its own, or that of the scene
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

// A file that a scene was read from, as it was then.
struct InputFile {
    std::filesystem::path path;
    std::string hash; // of its content
};

struct Scene {
    std::filesystem::path file;
    dvec3 origin{0}; // what all places count from, in the world: 0 unless the scene lies far out
    double frame_rate = 24;
    int first_frame = 1, last_frame = 1; // what --frames means when it is not given
    ivec2 resolution{640, 360};
    Keyed<float> exposure{0.0f}; // stops, of PNGs, ...
    bool own_exposure = false;   // ... where the scene states one
    std::vector<Node> nodes;
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<Instance> instances;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<CameraSource> cameras;
    int camera = 0; // the default one
    std::vector<LightSource> lights;
    Keyed<vec3> ambient{vec3(0)}; // uniform radiance from everywhere, unshadowed
    std::vector<MediumSource> media;
    Background background;
    std::optional<EnvironmentSource> environment;
    std::vector<Billboard> billboards;
    std::vector<InputFile> inputs;     // every file read, for hashes and reloading
    std::vector<std::string> warnings; // one line each, said once
};

// Reads a scene file, or a bare .gltf, .glb or .vdb: what these lack is made up, with warnings. Throws Error.
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

// A scene from the text of a scene file that need not exist: paths in it are relative to where `file` would be.
Scene load_scene_text(std::string_view text, const std::filesystem::path& file, const LoadOptions& options = {});

// Local to world, and the same counted from the scene's origin. Node -1 is the world.
dmat4 world_matrix(const Scene& scene, int node, double seconds);
mat4 node_matrix(const Scene& scene, int node, double seconds);

// Whether the scene gives keys to a node (-1 = none) or one above it.
bool is_moving(const Scene& scene, int node);

mat4 medium_matrix(const MediumSource& medium, double seconds); // of the medium's own space, to world

// The first and the last frame whose files a medium shows while the shutter of a frame is open.
std::pair<int, int> frames_shown(const MediumSource& medium, int frame, const Shutter& shutter);

// The files of sequences that a frame reads, volumes first; nothing where one has none for it. Throws Error for a gap.
struct FrameFile {
    bool volume = true; // else a gobo
    std::optional<std::filesystem::path> path;
};
std::vector<FrameFile> frame_files(const Scene& scene, int frame, MissingFrame missing, const Shutter& shutter);

// The picture of a gobo for a frame; where gaps are skipped elsewhere, the one before goes on.
std::filesystem::path gobo_file(const GoboSource& gobo, int frame, MissingFrame missing);
// The files of a medium: of its density and of every other property, each once.
std::vector<const FileSequence*> volume_sequences(const MediumSource& medium);

// Whether it emits light at any time.
bool emits_light(const MediumSource& medium);

// Around every instance at a moment, and every medium whose extent is known without opening volumes.
Box scene_bounds(const Scene& scene, double seconds);
}
