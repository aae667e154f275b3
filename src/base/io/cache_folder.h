// A folder of files that hold what is costly to make and the same in many processes. Files are named by a hash of all
// that they depend on, written once and never changed.
#pragma once
#include "base/clock.h"
#include "base/io/cache_file.h"

#include <map>
#include <mutex>

namespace tyndall {
// A file of the folder.
struct CacheEntry {
    FileStamp stamp;  // as it was written
    std::string hash; // of its body; empty = not known yet
};

enum class CostKind { cached, found, rebuilt, no_room }; // found: an earlier run had cached it

// What something costs every process that does not find it.
struct CacheCost {
    std::string what;
    double seconds = 0;
    CostKind kind = CostKind::rebuilt;
    std::string file{}; // of the folder; empty = none
};

struct CacheFolder {
    std::filesystem::path folder;
    std::filesystem::path local{}; // copies are made and read here; empty = none
    std::string build{};           // and instruction set: in all names
    std::string plan{};            // hash of what the things of a frame are made for
    std::shared_ptr<FileHashes> inputs = std::make_shared<FileHashes>();
    std::map<std::string, CacheEntry> files{}; // that are there, by name
    bool writes = false;                       // adds what is not there yet ...
    uint64_t room = 0;                         // ... up to so many bytes
    std::vector<CacheCost> costs{};            // of what was asked for since they were last taken out
    std::vector<std::weak_ptr<const CacheFile>> open{};
    std::mutex mutex{}; // held to change any of it
};

inline constexpr std::string_view cache_extension = ".cache";
std::string cache_file_name(std::string_view what, std::string_view made_from); // light-grid-0123...ef.cache
std::string made_from_hash(const CacheFolder& folder, std::string_view what, std::string_view content);

// The file of that name, null where there is none. Where bytes may have changed since they were checked, they are
// checked again. Throws Error: unreadable, where a file is gone or cut that should be there; refused.
std::shared_ptr<const CacheFile> find_cache_file(CacheFolder& folder, const std::string& what,
                                                 const std::string& made_from);

// Writes a thing, if there is room, and notes what it cost. Throws Error (unwritable).
void keep_in_folder(CacheFolder& folder, const std::string& what, const std::string& made_from, double seconds,
                    const CacheWriter& fields);

// Notes what something costs that is in no file; folder may be null.
void note_cost(CacheFolder* folder, std::string_view what, double seconds, CostKind kind = CostKind::rebuilt,
               std::string file = {});

// The time that making things took which were noted and not found.
double noted_seconds(CacheFolder* folder);

// Reads every byte of a file of the folder. Throws Error: unreadable, where it is gone or cut; refused.
void check_cache_file(const CacheFolder& folder, const std::string& name, const CacheEntry& entry);

// Throws Error (unreadable) where a file was changed while it was open.
void check_unchanged(CacheFolder& folder);

// A thing that `content` says all about, from a file of the folder or else made, and then kept where the folder is
// written to. Without folder or content it is just made.
template<class T, class Make>
T found_or_made(CacheFolder* folder, const std::string& what, const std::string& content, const Make& make) {
    if (!folder) return make();
    if constexpr (requires(T thing, CacheWriter & writer) { fields(thing, writer); }) {
        if (!content.empty()) {
            const std::string made_from = made_from_hash(*folder, what, content);
            if (const std::shared_ptr<const CacheFile> file = find_cache_file(*folder, what, made_from)) {
                T thing{};
                CacheReader reader(file);
                fields(thing, reader);
                reader.finish();
                file->file.check_unchanged();
                return thing;
            }
            const double start = steady_seconds();
            T thing = make();
            const double seconds = steady_seconds() - start;
            CacheWriter writer;
            fields(thing, writer);
            keep_in_folder(*folder, what, made_from, seconds, writer);
            return thing;
        }
    }
    const double start = steady_seconds();
    T thing = make();
    note_cost(folder, what, steady_seconds() - start);
    return thing;
}
}
