#include "volume/vdb/file/head.h"

#include "base/io/file.h"
#include "base/text.h"

#include <openvdb/MetaMap.h>
#include <openvdb/Metadata.h>
#include <openvdb/version.h>

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
// Strings, except for the keys that readers expect as numbers (the library's text form of a double round-trips).
openvdb::MetaMap metadata_map(const VdbMetadata& texts, const std::string& creator) {
    constexpr std::string_view whole[] = {"tyndall_schema", "tyndall_seed"};
    constexpr std::string_view real[] = {"tyndall_frame",  "tyndall_time_s",           "tyndall_fps",
                                         "tyndall_unit_m", "tyndall_extinction_per_m", "tyndall_g"};
    openvdb::MetaMap metadata;
    for (const auto& [key, text] : texts) {
        if (key.empty() || key == "creator") continue;
        metadata.removeMeta(key);
        const std::optional<double> value = parsed<double>(text);
        const auto is_key = [&](std::string_view name) { return name == key; };
        if (value && std::ranges::any_of(whole, is_key) && *value == std::floor(*value) && std::abs(*value) < 1e15)
            metadata.insertMeta(key, openvdb::Int64Metadata(static_cast<int64_t>(*value)));
        else if (value && std::ranges::any_of(real, is_key))
            metadata.insertMeta(key, openvdb::DoubleMetadata(*value));
        else
            metadata.insertMeta(key, openvdb::StringMetadata(text));
    }
    metadata.insertMeta("creator", openvdb::StringMetadata(creator));
    return metadata;
}

// Position of the 36-character UUID, which the library would fill at random.
constexpr size_t uuid_begin = 21, uuid_bytes = 36;
constexpr std::string_view nought = "00000000-0000-0000-0000-000000000000";

std::string uuid_of(std::string digits) {
    for (const size_t hyphen : {8, 13, 18, 23}) digits.insert(hyphen, "-");
    return digits;
}

void write_header(std::ostream& stream) {
    write_value<int64_t>(stream, openvdb::OPENVDB_MAGIC);
    write_value<uint32_t>(stream, openvdb::OPENVDB_FILE_VERSION);
    write_value<uint32_t>(stream, openvdb::OPENVDB_LIBRARY_MAJOR_VERSION);
    write_value<uint32_t>(stream, openvdb::OPENVDB_LIBRARY_MINOR_VERSION);
    write_value<char>(stream, 1); // grids have offsets
    stream << nought;
}
}

void write_head(std::ostream& stream, const VdbMetadata& metadata, const std::string& creator, size_t grids) {
    write_header(stream);
    metadata_map(metadata, creator).writeMeta(stream);
    write_value(stream, static_cast<int32_t>(grids));
}

void set_uuid(std::string& head, std::string digits) {
    head.replace(uuid_begin, uuid_bytes, uuid_of(std::move(digits)));
}

bool has_content_uuid(std::string_view file) {
    if (file.size() < uuid_begin + uuid_bytes) return false;
    const std::string_view pieces[] = {file.substr(0, uuid_begin), nought, file.substr(uuid_begin + uuid_bytes)};
    return file.substr(uuid_begin, uuid_bytes) == uuid_of(content_hash(pieces));
}
}
