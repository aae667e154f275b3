#include "trace/fog/grid_file.h"

#include "base/error.h"
#include "base/text.h"
#include "scene/scene.h"
#include "trace/fog/motion.h"
#include "volume/vdb/vdb.h"

#include <algorithm>

namespace tyndall {
namespace {
namespace fs = std::filesystem;

// The last file before `file` that has the grids; nothing if there is none, or if a file without any grid comes first.
std::optional<fs::path> earlier_file(const std::vector<fs::path>& files, const fs::path& file,
                                     std::span<const std::string> grids) {
    for (auto place = std::ranges::find(files, file); place != files.begin();) {
        const GridsFound found = find_vdb_grids(*--place, grids);
        if (found == GridsFound::all) return *place;
        if (found == GridsFound::empty_file) break;
    }
    return {};
}

std::string grid_names(std::span<const std::string> grids) {
    return "\"" + printable(joined({grids.begin(), grids.end()}, "\", \""), 120) + "\"";
}
}

std::span<const std::string> density_grids(const MediumSource& medium) {
    return {&medium.density_grid, medium.density_grid.empty() ? 0u : 1u};
}

std::optional<fs::path> grid_file(const FileSequence& sequence, std::span<const std::string> grids, int frame,
                                  MissingFrame missing, std::vector<std::string>& notes) {
    const auto file = sequence_file(sequence, frame, missing);
    note_gap(sequence, frame, missing, notes);
    if (!file || sequence.files.empty()) return file;
    const auto note = [&](const std::string& what) {
        std::string line = file->filename().string() + ": " + what;
        if (!std::ranges::count(notes, line)) notes.push_back(std::move(line));
    };
    const GridsFound found = find_vdb_grids(*file, grids);
    if (found == GridsFound::all) return file;
    if (found == GridsFound::empty_file) {
        note("contains no grids: nothing is shown");
        return {};
    }

    // The last file first: what a simulation does not have at first, it mostly has in the end.
    std::vector<fs::path> files = all_files(sequence);
    const bool elsewhere = std::any_of(files.rbegin(), files.rend(), [&](const fs::path& other) {
        return find_vdb_grids(other, grids) == GridsFound::all;
    });
    if (!elsewhere) return file; // reading it names the grids there are
    const std::string lacks = "has no grid " + grid_names(grids);
    if (missing == MissingFrame::error)
        refuse(file->string(),
               lacks + ", unlike other files of the sequence; --missing hold or skip continues without it");
    const auto held = missing == MissingFrame::hold ? earlier_file(files, *file, grids) : std::nullopt;
    note(lacks + ": " + (held ? held->filename().string() + " is shown instead" : "nothing is shown"));
    return held;
}
}
