// Edits of JSON text that leave every other byte unchanged: comments, order, indentation, line endings. Positions are
// JSON pointers (RFC 6901). The text must have been parsed before; throws Error (refused) if it is not JSON.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tyndall {
// The bytes [begin, end) of a text.
struct TextSpan {
    size_t begin = 0, end = 0;
    std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
};

// The bytes of the value at a pointer; empty if there is none.
std::optional<TextSpan> find_json(std::string_view text, std::string_view pointer);

// The text with the value at a pointer replaced by `value`, or inserted if it is absent: a new member goes last in its
// object, formatted like its neighbors; missing parents become objects; "/list/7" may be one past the last item.
std::string with_json(std::string_view text, std::string_view pointer, std::string_view value);

// The text with a new item before the index-th of the array at a pointer, or after the last one.
std::string with_json_item(std::string_view text, std::string_view array, size_t index, std::string_view value);

// One step of indentation, and the line ending, of this text.
std::string indentation_of(std::string_view text); // empty if the text is one line
std::string line_end_of(std::string_view text);
}
