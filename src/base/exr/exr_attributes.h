// Header attributes as text, and the one that tells whether a file is as it was written.
#pragma once
#include <ImfAttribute.h>

#include <string>
#include <string_view>

namespace tyndall {
// A header's tyndall:check is the hash of its file with this in its place.
inline constexpr const char* check_name = "tyndall:check";
inline constexpr std::string_view no_check = "00000000000000000000000000000000";
inline constexpr std::string_view before_check{"tyndall:check\0string\0\x20\0\0\0", 25}; // as a file holds it

// The value of an attribute: strings as they are, numbers in C notation separated by spaces, other types as <type>.
std::string attribute_text(const Imf::Attribute& attribute);
}
