// Header attributes as text, and the checksum attribute that detects a modified file.
#pragma once
#include <ImfAttribute.h>

#include <string>
#include <string_view>

namespace tyndall {
// tyndall:check holds the hash of the whole file, computed with no_check in its place.
inline constexpr const char* check_name = "tyndall:check";
inline constexpr std::string_view no_check = "00000000000000000000000000000000";
inline constexpr std::string_view before_check{"tyndall:check\0string\0\x20\0\0\0", 25}; // as stored in a file

// The value of an attribute: strings verbatim, numbers in C notation separated by spaces, other types as <type>.
std::string attribute_text(const Imf::Attribute& attribute);
}
