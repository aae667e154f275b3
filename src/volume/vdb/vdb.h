// OpenVDB files in and out and NanoVDB files in, guarded against cut, hostile and half-written ones. The only user of
// both.
#pragma once
#include "volume/bricks/sparse_volume.h"
#include "volume/value_map.h"
#include "volume/vdb/roles.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tyndall {
// Whether a file is called as these are: .vdb, .nvdb.
bool is_volume_name(const std::filesystem::path& file);

struct VdbWriteOptions {
    bool half = true;  // 16-bit floats on disk
    bool blosc = true; // else ZIP
    std::string creator = "tyndall " TYNDALL_VERSION;
};

// The leaves of one place: of numbers one, of vectors three, grid after grid.
using LeafFill = std::function<void(size_t number, std::span<Leaf> leaves)>;

struct VdbGridContent {
    std::string name = "density";
    bool vector = false; // a velocity in metres per second, else a number that is never negative
};

// Grids on the same voxels whose leaves are computed while they are written, so that no more than a few exist at a
// time. Active are the voxels where any of the numbers is not 0.
struct VdbContent {
    std::vector<VdbGridContent> grids; // the first holds numbers
    dmat4 index_to_world{1};
    std::vector<std::pair<std::string, std::string>> metadata;
    std::vector<Tile> tiles;    // of a lone grid; disjoint from the leaves and each other
    std::vector<ivec3> origins; // of the leaves, multiples of 8, no two alike
    LeafFill fill;              // every value of the leaves; called once for each place, on several threads
};

// Writes one fog grid (class fog volume, background 0, zero voxels inactive) atomically. Same input, same bytes.
// The metadata goes into the file's metadata. Throws Error (unwritable).
void write_vdb(const std::filesystem::path& file, const SparseVolume& volume, const VdbWriteOptions& options = {});

// The same in two steps, of which only the second waits for the disk.
class VdbImage {
public:
    VdbImage(const VdbContent& content, const VdbWriteOptions& options, const std::string& where);
    VdbImage(VdbImage&&) noexcept;
    ~VdbImage();

    void write(const std::filesystem::path& file) const;
    uint64_t voxels() const; // that are active, in leaves of one grid

private:
    std::unique_ptr<struct EncodedFog> fog_;
};

struct VdbGridInfo {
    std::string name, type, grid_class; // "density", "float", "fog volume"
    std::string key;                    // what to ask read_vdb for: "density[1]" where several have the name
    GridRole role = GridRole::other;    // what it looks like
    bool usable = false;                // can be rendered as fog
    bool is_fog = false;                // is, where no grid is named
    std::string why_not;                // when it cannot
    dmat4 index_to_world{1};
    vec3 voxel_size{0};
    ivec3 active_low{0}, active_high{-1};
    uint64_t active_voxels = 0, leaves = 0, tiles = 0;
    float minimum = 0, maximum = 0, mean = 0, background = 0; // of vectors of the first component
    std::vector<Interval<float>> ranges;                      // of vectors: of each component
    uint64_t non_finite = 0, negative = 0;
    uint64_t memory_bytes = 0;
    std::vector<std::pair<std::string, std::string>> metadata;
};

struct VdbInfo {
    std::string format; // OpenVDB or NanoVDB
    uint32_t file_version = 0;
    std::string library_version, compression;
    std::vector<std::pair<std::string, std::string>> metadata;
    std::vector<VdbGridInfo> grids;
};

// Throws Error: unreadable, refused (not a VDB, cut, hostile; the message names the place).
VdbInfo vdb_info(const std::filesystem::path& file);

// What was mended while reading; say it to the user once per file.
struct VdbReadReport {
    uint64_t non_finite = 0, negative = 0; // voxels set to 0
    uint64_t above = 0;                    // voxels above the most that is wanted, which they are set to
    float most = infinity;                 // that
    float background = 0;                  // non-zero: fog outside the active box was dropped
    std::string grid;                      // the one that was read
    bool empty = false;                    // it holds no active voxels
    std::string summary() const;           // empty when there is nothing to say
};

// Reads one grid as fog. `grid`: a name, name[index] for the index-th of that name, or empty for "density", else for
// the only one that can be fog and is not called as another quantity is. Throws Error: an unknown name lists what is
// there, a level set says what to do.
SparseVolume read_vdb(const std::filesystem::path& file, const std::string& grid = {}, VdbReadReport* report = nullptr);

// The same with every value mapped before it is cleaned. Where the grid has no voxels it stays 0. Level sets are taken
// with a map that has a width, which may not pass their narrow band. Values above `most` are set to it and counted.
SparseVolume read_vdb(const std::filesystem::path& file, const std::string& grid, const ValueMap& map, float most,
                      VdbReadReport* report);

// A colour from a grid of vectors, three grids of numbers, or one of them for all channels.
struct ColorVolume {
    std::vector<SparseVolume> channels; // three, or one for all; 0 where `there` is
    SparseVolume there;                 // 1 at active voxels
};
// `grids`: a name, or three. A name that is not there stands for name.x, name.y and name.z where these are. Values
// above `most` are set to it and counted. Throws Error as read_vdb().
ColorVolume read_color_vdb(const std::filesystem::path& file, std::span<const std::string> grids, const ValueMap& map,
                           float most, VdbReadReport* report);

// A velocity, in the file's lengths and whatever its unit of time is.
struct VelocityVolume {
    std::array<SparseVolume, 3> components; // of either sign; where the grid is staggered, each on voxels of its own
    std::vector<SparseVolume> known;        // 1 where there is one: of all components, or of each
};
// `grids` as of a color; one of numbers alone is refused. What is not finite is set to 0 and counted.
VelocityVolume read_velocity_vdb(const std::filesystem::path& file, std::span<const std::string> grids,
                                 const ValueMap& map, VdbReadReport* report);

// Metadata of the file without its voxels (optics and frame written by a bake).
std::vector<std::pair<std::string, std::string>> vdb_metadata(const std::filesystem::path& file);

// Whether every byte of a file is as this program wrote it. Throws Error (unreadable).
bool is_as_written(const std::filesystem::path& file);
}
