// The head of a file: what it is, who it is, what its author says of it.
#pragma once
#include "volume/vdb/prewalk.h"

#include <ostream>
#include <string>

namespace tyndall {
// Up to and including the number of grids. The identity is still nought.
void write_head(std::ostream& stream, const VdbMetadata& metadata, const std::string& creator, size_t grids);

// Puts 32 hex digits in the place of the file's UUID.
void set_identity(std::string& head, std::string digits);

// Whether the UUID at the head of a whole file is the hash of all else in it, as in files that this program has
// written.
bool has_identity_of_content(std::string_view file);

template<class T> void write_value(std::ostream& stream, T value) {
    stream.write(reinterpret_cast<const char*>(&value), sizeof value);
}
}
