// The header of an OpenVDB file: magic and versions, UUID, and file metadata.
#pragma once
#include "volume/vdb/file/prewalk.h"

#include <ostream>
#include <string>

namespace tyndall {
// Writes everything up to and including the number of grids, with an all-zero UUID.
void write_head(std::ostream& stream, const VdbMetadata& metadata, const std::string& creator, size_t grids);

// Sets the file's UUID from 32 hex digits.
void set_uuid(std::string& head, std::string digits);

// True if the UUID of a complete file is the hash of all its other bytes, as in files written by this program.
bool has_content_uuid(std::string_view file);

template<class T> void write_value(std::ostream& stream, T value) {
    stream.write(reinterpret_cast<const char*>(&value), sizeof value);
}
}
