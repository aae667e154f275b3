// JSON pointers (RFC 6901): how errors name a location in a document.
#pragma once
#include <string>
#include <string_view>

namespace tyndall {
// "/lights" and "a/b" give "/lights/a~1b".
inline std::string json_pointer(std::string_view parent, std::string_view key) {
    std::string pointer(parent);
    pointer += '/';
    for (const char c : key) {
        if (c == '~')
            pointer += "~0";
        else if (c == '/')
            pointer += "~1";
        else
            pointer += c;
    }
    return pointer;
}

inline std::string json_pointer(std::string_view parent, size_t index) {
    return std::string(parent) + "/" + std::to_string(index);
}

// The unescaped key of one pointer segment: "a~1b" gives "a/b".
inline std::string json_pointer_key(std::string_view part) {
    std::string key;
    for (size_t i = 0; i < part.size(); ++i) {
        const bool escape = part[i] == '~' && i + 1 < part.size();
        key += !escape ? part[i] : part[i + 1] == '1' ? '/' : '~';
        i += escape;
    }
    return key;
}

// "scenes/a.json: /lights/0"; only the file for the root.
inline std::string json_location(std::string_view file, std::string_view pointer) {
    return std::string(file) + (pointer.empty() ? "" : ": ") + std::string(pointer);
}
}
