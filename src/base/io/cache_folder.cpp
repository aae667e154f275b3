#include "base/io/cache_folder.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/io/temporary.h"
#include "base/text.h"

namespace tyndall {
namespace {
std::string made_from_of(const std::string& name) { // the 32 digits before the extension
    const size_t end = name.rfind('.');
    return end == name.npos || end < 32 ? std::string() : name.substr(end - 32, 32);
}

// Missing and truncated files count as unreadable, not damaged: a network drive may complete them later.
void check_size(const std::filesystem::path& path, uint64_t size, const CacheEntry& entry) {
    if (size != entry.stamp.size)
        fail(ExitCode::unreadable, path.string(),
             formatted("is truncated or was replaced: has %llu of %llu bytes; prepare again",
                       static_cast<unsigned long long>(size), static_cast<unsigned long long>(entry.stamp.size)));
}

std::shared_ptr<const CacheFile> opened(const std::filesystem::path& path, const std::string& name,
                                        const CacheEntry& entry) {
    check_size(path, stamp_of(path).size, entry);
    auto file = open_cache_file(path, made_from_of(name));
    if (entry.hash.empty())
        check_body(*file);
    else if (file->hash != entry.hash)
        refuse(path.string(), "is not the file that was prepared: prepare again");
    return file;
}

// Path of the copy in the local folder, made if missing. The source is verified before it is copied.
std::filesystem::path local_copy(const CacheFolder& folder, const std::string& name, const CacheEntry& entry) {
    std::filesystem::path copy = folder.local / name;
    std::error_code none;
    if (std::filesystem::file_size(copy, none) == entry.stamp.size && !none) return copy;
    const auto file = opened(folder.folder / name, name, entry);
    check_body(*file);
    check_output(copy);
    sweep_temporaries(folder.local);
    write_file_atomically(copy, file->file.bytes());
    return copy;
}
}

std::string cache_file_name(std::string_view what, std::string_view made_from) {
    std::string name(what);
    std::ranges::replace(name, ' ', '-');
    return name.append("-").append(made_from).append(cache_extension);
}

std::string made_from_hash(const CacheFolder& folder, std::string_view what, std::string_view content) {
    return content_hash(std::string(what).append("\n").append(folder.build).append("\n").append(content));
}

std::shared_ptr<const CacheFile> find_cache_file(CacheFolder& folder, const std::string& what,
                                                 const std::string& made_from) {
    const std::string name = cache_file_name(what, made_from);
    const std::scoped_lock lock(folder.mutex);
    const auto entry = folder.files.find(name);
    if (entry == folder.files.end()) return nullptr;
    const bool local = !folder.local.empty();
    const auto file =
        opened(local ? local_copy(folder, name, entry->second) : folder.folder / name, name, entry->second);
    if (!local && file->file.stamp() != entry->second.stamp) check_body(*file);
    entry->second.hash = file->hash;
    folder.open.push_back(file);
    folder.costs.push_back({what, file->seconds, CostKind::found, name});
    return file;
}

void keep_in_folder(CacheFolder& folder, const std::string& what, const std::string& made_from, double seconds,
                    const CacheWriter& fields) {
    if (!folder.writes) return record_cost(&folder, what, seconds);
    const std::string name = cache_file_name(what, made_from);
    const std::filesystem::path path = folder.folder / name;
    const uint64_t size = cache_file_size(fields.pieces());
    const std::scoped_lock lock(folder.mutex);
    if (size > folder.room) return folder.costs.push_back({what, seconds, CostKind::no_room});
    const std::string hash = write_cache_file(path, made_from, seconds, fields.pieces());
    folder.room -= size;
    folder.files[name] = {stamp_of(path), hash};
    folder.costs.push_back({what, seconds, CostKind::cached, name});
}

void record_cost(CacheFolder* folder, std::string_view what, double seconds, CostKind kind, std::string file) {
    if (!folder) return;
    const std::scoped_lock lock(folder->mutex);
    folder->costs.push_back({std::string(what), seconds, kind, std::move(file)});
}

double rebuild_seconds(CacheFolder* folder) {
    if (!folder) return 0;
    const std::scoped_lock lock(folder->mutex);
    double sum = 0;
    for (const CacheCost& cost : folder->costs) sum += cost.kind == CostKind::found ? 0 : cost.seconds;
    return sum;
}

void check_cache_file(const CacheFolder& folder, const std::string& name, const CacheEntry& entry) {
    check_body(*opened(folder.folder / name, name, entry));
}

void check_unchanged(CacheFolder& folder) {
    const std::scoped_lock lock(folder.mutex);
    for (const std::weak_ptr<const CacheFile>& open : folder.open)
        if (const std::shared_ptr<const CacheFile> file = open.lock()) file->file.check_unchanged();
}
}
