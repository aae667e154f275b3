// Frame ranges (1-10, 1-10x2 or 1-10:2, 1,5,9, -3-4) and numbered file names (####, %04d, $F4, @@@@, <F4>).
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// The frames of a range in the order written, without duplicates. Throws Error (usage) naming the column that is wrong.
std::vector<int> parse_frames(std::string_view text);

// All of them, first and last too.
std::vector<int> frames_between(int first, int last);

// The first, the last, then again and again the middle of what is left between two: whenever a render stops, what is
// there is spread over the shot.
std::vector<int> spread_frames(const std::vector<int>& frames);

// "1-48", "1-9x2,20": the shortest way back.
std::string format_frames(const std::vector<int>& frames);

bool has_frame_token(std::string_view pattern);

// The pattern with a word and a dot before its token, or before its extension: out.####.exr -> out.march.####.exr.
std::string with_word(std::string_view pattern, std::string_view word);

// The pattern with its token replaced: name.####.exr, 12 -> name.0012.exr. Negative frames keep their sign: -0003.
std::string frame_name(std::string_view pattern, int frame);
}
