// Ranges of depth of blocks of a shadow map's texels, each level's blocks twice as wide as those of the level before.
#pragma once
#include "trace/shadows/maps/shadow_map.h"

namespace tyndall {
inline constexpr int block_side = 4; // texels across the smallest blocks

// From the finished depths.
void make_blocks(ShadowMap& map);
}
