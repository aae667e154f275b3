// Header attributes of our pictures, and any header attribute as text. For the EXR files of this folder only.
#pragma once
#include "render/image/exr.h"

#include <ImfHeader.h>

#include <string>

namespace tyndall {
Imf::Header make_exr_header(const Layers& layers, const Provenance& provenance);

// The value of an attribute: strings as they are, numbers in C notation separated by spaces, other types as <type>.
std::string attribute_text(const Imf::Attribute& attribute);
}
