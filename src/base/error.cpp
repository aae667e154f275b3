#include "base/error.h"

#include <cstdio>

namespace tyndall {
Error::Error(ExitCode exit_code, std::string_view where, std::string_view what)
    : std::runtime_error(printable(where, 220) + (where.empty() ? "" : ": ") + printable(what, 250)), code(exit_code) {}

void fail(ExitCode code, std::string_view where, std::string_view what) { throw Error(code, where, what); }
void refuse(std::string_view where, std::string_view what) { throw Error(ExitCode::refused, where, what); }

std::string printable(std::string_view text, size_t most) {
    std::string result;
    for (const unsigned char c : text) {
        char escaped[8] = {static_cast<char>(c), 0};
        if (c < 0x20 || c == 0x7f) std::snprintf(escaped, sizeof escaped, "\\x%02x", c);
        if (result.size() + 7 > most) {
            result += "...";
            break;
        }
        result += escaped;
    }
    return result;
}
}
