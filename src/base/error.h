// One exception for everything a user can cause: where it happened, what is wrong, and the exit code it means.
#pragma once
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tyndall {
// What a process of the program ends with (exit_codes() says what each means).
enum class ExitCode {
    ok = 0,
    differs = 1,
    usage = 2,
    refused = 3,
    unreadable = 4,
    unwritable = 5,
    non_finite = 6,
    out_of_memory = 33,
    no_display = 69,
    internal = 70,
    stopped = 128, // plus the number of the signal
};

struct ExitCodeMeaning {
    ExitCode code;
    std::string_view meaning;
};
// The one table: --help and the docs derive from it.
std::span<const ExitCodeMeaning> exit_codes();

class Error : public std::runtime_error {
public:
    Error(ExitCode exit_code, std::string_view where, std::string_view what);
    ExitCode code;
};

// `where` names file and field ("scenes/a.json: /lights/0/type"), `what` says what is wrong and what would do.
[[noreturn]] void fail(ExitCode code, std::string_view where, std::string_view what);
[[noreturn]] void refuse(std::string_view where, std::string_view what); // input is wrong: exit code 3

// Runs `body`; an Error that it throws gets `where` in front.
decltype(auto) within(std::string_view where, const auto& body) {
    try {
        return body();
    } catch (const Error& error) {
        fail(error.code, where, error.what());
    }
}

// Foreign text made fit for one line of output: control bytes escaped, cut to `most` bytes.
std::string printable(std::string_view text, size_t most = 200);
}
