// Header attributes of our pictures, and any header attribute as text. For the EXR files of this folder only.
#pragma once
#include "render/image/exr.h"

#include <ImfHeader.h>

#include <string>
#include <string_view>

namespace tyndall {
Imf::Header make_exr_header(const ExrWindow& window, const Provenance& provenance);

// A header's tyndall:check is the hash of its file with this in its place.
inline constexpr const char* check_name = "tyndall:check";
inline constexpr std::string_view no_check = "00000000000000000000000000000000";
inline constexpr std::string_view before_check{"tyndall:check\0string\0\x20\0\0\0", 25}; // as a file holds it

// The value of an attribute: strings as they are, numbers in C notation separated by spaces, other types as <type>.
std::string attribute_text(const Imf::Attribute& attribute);
}
