// Min-max mipmap of a shadow map: depth ranges of blocks of texels, each level's blocks twice as wide as the last.
#pragma once
#include "trace/shadows/maps/shadow_map.h"

namespace tyndall {
inline constexpr int block_side = 4; // texels across the smallest blocks

// Builds the blocks from the finished depths.
void make_blocks(ShadowMap& map);
}
