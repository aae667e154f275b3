// Changes to JSON text that leave every other byte as it was: comments, order, indentation, line ends.
// Places are JSON pointers (RFC 6901). The text has been parsed already; Error (refused) where it is not JSON after
// all.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tyndall {
// Bytes begin..end (excluded) of a text.
struct TextSpan {
    size_t begin = 0, end = 0;
    std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
};

// The bytes of the value at a pointer; nothing when there is none.
std::optional<TextSpan> find_json(std::string_view text, std::string_view pointer);

// The text with the value at a pointer replaced by `value`, or put in when it is absent: a new member comes last in its
// object and is set as its neighbours are; missing parents become objects; "/list/7" may be one past the last item.
std::string with_json(std::string_view text, std::string_view pointer, std::string_view value);

// The text with a new item before the index-th of the array at a pointer, or behind the last one.
std::string with_json_item(std::string_view text, std::string_view array, size_t index, std::string_view value);

// What stands for one step of indentation, and for a line's end, in this text.
std::string indentation_of(std::string_view text); // empty when the text is one line
std::string line_end_of(std::string_view text);
}
