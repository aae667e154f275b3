#include "base/error.h"

#include "base/utf8.h"

#include <algorithm>
#include <cstdio>

namespace tyndall {
namespace {
// Escapes everything a terminal could act on (control characters, malformed UTF-8) in the form \x1b.
std::string escaped(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const size_t length = utf8_length(text), taken = std::max<size_t>(length, 1);
        const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
        const bool control = byte(0) < 0x20 || byte(0) == 0x7f || (length == 2 && byte(0) == 0xc2 && byte(1) < 0xa0);
        char code[8];
        for (size_t i = 0; i < taken; ++i) {
            std::snprintf(code, sizeof code, "\\x%02x", byte(i));
            if (control || length == 0)
                result += code;
            else
                result += text[i];
        }
        text.remove_prefix(taken);
    }
    return result;
}

bool inside_character(std::string_view text, size_t at) { return at < text.size() && (text[at] & 0xc0) == 0x80; }

// Keeps both ends of a long location: the file name at the front and the field at the back.
std::string shortened_place(std::string_view where) {
    constexpr size_t most = 220, head = 100, tail = most - head;
    const std::string front = escaped(where.substr(0, most + 4));
    if (front.size() <= most) return front;
    size_t start = where.size() - std::min(where.size(), tail);
    while (inside_character(where, start)) ++start;
    const std::string back = escaped(where.substr(start));
    start = back.size() - std::min(back.size(), tail);
    while (inside_character(back, start)) ++start;
    return printable(front, head) + back.substr(start);
}
}

std::span<const ExitCodeMeaning> exit_codes() {
    static constexpr ExitCodeMeaning table[] = {
        {ExitCode::ok, "done"},
        {ExitCode::differs,
         "error target or time budget missed (render, merge), parts missing (merge --partial), frames unfinished "
         "(status), submission failed (submit), no mode meets the target (plan), problems found (check), a limit "
         "exceeded (compare), a failed check (verify), a mode that fails silently (stress)"},
        {ExitCode::usage, "invalid command line"},
        {ExitCode::refused, "invalid input: the message names file and field"},
        {ExitCode::unreadable, "an input is missing or cannot be read"},
        {ExitCode::unwritable, "the output cannot be written"},
        {ExitCode::non_finite, "done, but some samples or pixels were not finite"},
        {ExitCode::out_of_memory, "out of memory"},
        {ExitCode::no_display, "no display for the viewer, or a processor without AVX2"},
        {ExitCode::internal, "internal error: a bug in tyndall"},
        {ExitCode::stopped, "stopped by signal n"},
    };
    return table;
}

Error::Error(ExitCode exit_code, std::string_view where, std::string_view what)
    : std::runtime_error(shortened_place(where) + (where.empty() ? "" : ": ") + printable(what, 250)), code(exit_code) {
}

void fail(ExitCode code, std::string_view where, std::string_view what) { throw Error(code, where, what); }
void refuse(std::string_view where, std::string_view what) { throw Error(ExitCode::refused, where, what); }

std::string printable(std::string_view text, size_t most) {
    // Take four bytes more than fit: a character split by this first cut is dropped by the second.
    std::string result = escaped(text.substr(0, most + 4));
    if (result.size() <= most) return result;
    size_t end = most - std::min<size_t>(most, 3);
    while (inside_character(result, end)) --end;
    return result.substr(0, end) + "...";
}
}
