// A folder of cache files with expensive precomputed objects that many processes share. Each file is named by a hash of
// everything it depends on, written once and never changed.
#pragma once
#include "base/clock.h"
#include "base/io/cache_file.h"

#include <map>
#include <mutex>

namespace tyndall {
// A file of the folder.
struct CacheEntry {
    FileStamp stamp;  // as it was written
    std::string hash; // of its body; empty = unknown
};

enum class CostKind { cached, found, rebuilt, no_room }; // found: cached by an earlier run

// The build time of one object, paid by every process that does not find it in the cache.
struct CacheCost {
    std::string what;
    double seconds = 0;
    CostKind kind = CostKind::rebuilt;
    std::string file{}; // name in the folder; empty = none
};

struct CacheFolder {
    std::filesystem::path folder;
    std::filesystem::path local{}; // files are copied here and read from here; empty = none
    std::string build{};           // build and instruction set; part of every name's hash
    std::string plan{};            // hash of the plan that a frame's objects are built for
    std::shared_ptr<FileHashes> inputs = std::make_shared<FileHashes>();
    std::map<std::string, CacheEntry> files{}; // existing files by name
    bool writes = false;                       // may add missing files ...
    uint64_t room = 0;                         // ... up to this many bytes
    std::vector<CacheCost> costs{};            // of requests since the list was last cleared
    std::vector<std::weak_ptr<const CacheFile>> open{};
    std::mutex mutex{}; // guards all members
};

inline constexpr std::string_view cache_extension = ".cache";
std::string cache_file_name(std::string_view what, std::string_view made_from); // light-grid-0123...ef.cache
std::string made_from_hash(const CacheFolder& folder, std::string_view what, std::string_view content);

// The file for `what` and `made_from`, or null if the folder has none. Rehashes the body if it may have changed since
// the last check. Throws Error: unreadable if a listed file is missing or truncated; refused.
std::shared_ptr<const CacheFile> find_cache_file(CacheFolder& folder, const std::string& what,
                                                 const std::string& made_from);

// Writes an object if there is room, and records its cost. Throws Error (unwritable).
void keep_in_folder(CacheFolder& folder, const std::string& what, const std::string& made_from, double seconds,
                    const CacheWriter& fields);

// Records the cost of an object; `folder` may be null.
void record_cost(CacheFolder* folder, std::string_view what, double seconds, CostKind kind = CostKind::rebuilt,
                 std::string file = {});

// Total build time of the recorded objects that were not found in the cache, in seconds.
double rebuild_seconds(CacheFolder* folder);

// Verifies every byte of a file in the folder. Throws Error: unreadable if it is missing or truncated; refused.
void check_cache_file(const CacheFolder& folder, const std::string& name, const CacheEntry& entry);

// Throws Error (unreadable) if a file has changed while open.
void check_unchanged(CacheFolder& folder);

// Returns the object that `content` fully determines: loaded from the folder, or built with make() and then stored if
// the folder is writable. With no folder or empty content it is only built.
template<class T, class Make>
T load_or_build(CacheFolder* folder, const std::string& what, const std::string& content, const Make& make) {
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
    record_cost(folder, what, steady_seconds() - start);
    return thing;
}
}
