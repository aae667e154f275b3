// Sequential reader over the bytes of an OpenEXR file. Internal to this folder.
#pragma once
#include "base/error.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace tyndall {
struct ExrCursor {
    std::string_view left;
    const std::string& file;

    std::string_view bytes(size_t count) {
        if (count > left.size()) refuse(file, "the file is truncated or damaged");
        const std::string_view result = left.substr(0, count);
        left.remove_prefix(count);
        return result;
    }
    template<class T> T number() {
        T value;
        std::memcpy(&value, bytes(sizeof(T)).data(), sizeof(T));
        return value;
    }
    int32_t integer() { return number<int32_t>(); }
    std::string_view name() {
        const size_t end = left.substr(0, 256).find('\0');
        if (end == std::string_view::npos) refuse(file, "the header contains an unterminated name");
        const std::string_view result = bytes(end);
        bytes(1);
        return result;
    }
};
}
