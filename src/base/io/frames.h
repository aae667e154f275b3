// Frame ranges (1-10, 1-10x2 or 1-10:2, 1,5,9, -3-4) and numbered file names (####, %04d, $F4, @@@@, <F4>).
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// The frames of a range in the order written, without duplicates. Throws Error (usage) naming the offending column.
std::vector<int> parse_frames(std::string_view text);

// All frames first..last, inclusive.
std::vector<int> frames_between(int first, int last);

// Orders frames by bisection (first, last, then midpoints), so that a render stopped early covers the whole shot.
std::vector<int> spread_frames(const std::vector<int>& frames);

// "1-48", "1-9x2,20": the shortest text that parse_frames() turns back into these frames.
std::string format_frames(const std::vector<int>& frames);

bool has_frame_token(std::string_view pattern);

// The pattern with a word and a dot before its token, or before its extension: out.####.exr -> out.march.####.exr.
std::string with_word(std::string_view pattern, std::string_view word);

// The pattern with its token replaced: name.####.exr, 12 -> name.0012.exr. Negative frames keep their sign: -0003.
std::string frame_name(std::string_view pattern, int frame);
}
