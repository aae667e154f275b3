// Header attributes of EXR images. For the EXR files of this folder only.
#pragma once
#include "render/image/exr.h"

#include <ImfHeader.h>

namespace tyndall {
Imf::Header make_exr_header(const ExrWindow& window, const Provenance& provenance);
}
