// Reads OpenVDB and NanoVDB files and writes OpenVDB files, with checks against truncated and malicious input. The only
// interface to both libraries.
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
// True for the extensions .vdb and .nvdb.
bool is_volume_name(const std::filesystem::path& file);

struct VdbWriteOptions {
    bool half = true;  // 16-bit floats on disk
    bool blosc = true; // else ZIP
    std::string creator = "tyndall " TYNDALL_VERSION;
};

// Fills the leaves at one position: for each grid in turn, one leaf for scalars or three for vectors.
using LeafFill = std::function<void(size_t number, std::span<Leaf> leaves)>;

struct VdbGridContent {
    std::string name = "density";
    bool vector = false; // a velocity in meters per second; otherwise a nonnegative scalar
};

// Grids on the same voxels whose leaves are computed during writing, so that only a few exist at a time. Voxels are
// active where any of the scalars is nonzero.
struct VdbContent {
    std::vector<VdbGridContent> grids; // the first is a scalar grid
    dmat4 index_to_world{1};
    std::vector<std::pair<std::string, std::string>> metadata;
    std::vector<Tile> tiles;    // single grid only; disjoint from the leaves and each other
    std::vector<ivec3> origins; // of the leaves; multiples of 8, unique
    LeafFill fill;              // sets every value of the leaves; called once per origin, on several threads
};

// Writes one fog grid (class fog volume, background 0, zero voxels inactive) atomically and deterministically. The
// volume's metadata becomes file metadata. Throws Error (unwritable).
void write_vdb(const std::filesystem::path& file, const SparseVolume& volume, const VdbWriteOptions& options = {});

// write_vdb() in two steps, so that only the second waits for the disk.
class VdbImage {
public:
    VdbImage(const VdbContent& content, const VdbWriteOptions& options, const std::string& where);
    VdbImage(VdbImage&&) noexcept;
    ~VdbImage();

    void write(const std::filesystem::path& file) const;
    uint64_t voxels() const; // active voxels in the leaves of one grid

private:
    std::unique_ptr<struct EncodedFog> fog_;
};

struct VdbGridInfo {
    std::string name, type, grid_class; // "density", "float", "fog volume"
    std::string key;                    // name for read_vdb(): "density[1]" if several share the name
    GridRole role = GridRole::other;    // guessed quantity
    bool usable = false;                // as fog
    bool is_fog = false;                // the default if no grid is named
    std::string why_not;                // reason if not usable
    dmat4 index_to_world{1};
    vec3 voxel_size{0};
    ivec3 active_low{0}, active_high{-1};
    uint64_t active_voxels = 0, leaves = 0, tiles = 0;
    float minimum = 0, maximum = 0, mean = 0, background = 0; // for vectors: of the first component
    std::vector<Interval<float>> ranges;                      // for vectors: of each component
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

// Throws Error: unreadable, refused (not a VDB, truncated, malformed; the message names the location).
VdbInfo vdb_info(const std::filesystem::path& file);

// Corrections made while reading, to be reported to the user once per file.
struct VdbReadReport {
    uint64_t non_finite = 0, negative = 0; // voxels set to 0
    uint64_t above = 0;                    // active voxels clamped to `most`
    float most = infinity;                 // upper limit of the values
    float background = 0;                  // nonzero: fog outside the active box was dropped
    std::string grid;                      // name of the grid read
    bool empty = false;                    // no active voxels
    std::string summary() const;           // empty if there is nothing to report
};

// Reads one grid as fog. `grid`: a name, name[index] for the index-th grid of that name, or empty for the default:
// "density", or else the only usable grid whose name does not suggest another quantity. Throws Error: an unknown name
// lists the grids, a level set explains how to convert it.
SparseVolume read_vdb(const std::filesystem::path& file, const std::string& grid = {}, VdbReadReport* report = nullptr);

// The same with every value mapped before cleaning; space without voxels stays 0. Level sets need a map with a width
// within their narrow band. Values above `most` are clamped and counted. `quantity` is what errors call the values.
SparseVolume read_vdb(const std::filesystem::path& file, const std::string& grid, const ValueMap& map, float most,
                      VdbReadReport* report, std::string_view quantity = "density");

// A color from a vector grid, three scalar grids, or one scalar grid for all channels.
struct ColorVolume {
    std::vector<SparseVolume> channels; // three, or one for all; 0 where `coverage` is 0
    SparseVolume coverage;              // 1 at voxels that are active in any grid
};
// `grids`: one name or three. A name that does not exist stands for name.x, name.y and name.z if these do. Values above
// `most` are clamped and counted. Three grids need the same transform. Throws Error like read_vdb().
ColorVolume read_color_vdb(const std::filesystem::path& file, std::span<const std::string> grids, const ValueMap& map,
                           float most, VdbReadReport* report);

// A velocity in the file's units of length and time.
struct VelocityVolume {
    std::array<SparseVolume, 3> components; // signed; on separate voxel grids if staggered
    std::vector<SparseVolume> known;        // 1 at known voxels: one for all components, or one each
    SparseVolume any;                       // 1 where any component is known, if `known` differ; else empty
};
// `grids` as for a color, with any transforms; a single scalar grid is refused. Nonfinite values are set to 0 and
// counted.
VelocityVolume read_velocity_vdb(const std::filesystem::path& file, std::span<const std::string> grids,
                                 const ValueMap& map, VdbReadReport* report);

// Bounds of the fog that read_vdb() would read with these arguments, in the file's own space, without reading voxels;
// empty if the file does not state them. Throws Error like read_vdb().
Box stated_bounds(const std::filesystem::path& file, const std::string& grid, const ValueMap& map);

// File metadata (such as optics and frame written by a bake), without reading voxels.
std::vector<std::pair<std::string, std::string>> vdb_metadata(const std::filesystem::path& file);

// Whether a file has all of some grids, named as for a color, or no grid at all. Throws Error (unreadable, refused).
enum class GridsFound { all, not_all, empty_file };
GridsFound find_vdb_grids(const std::filesystem::path& file, std::span<const std::string> names);

// True if every byte of a file is as this program wrote it. Throws Error (unreadable).
bool is_as_written(const std::filesystem::path& file);
}
