// One exception type for every error a user can cause: where it happened, what is wrong, and the exit code.
#pragma once
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tyndall {
// Exit codes of the programs (exit_codes() says what each means).
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
// The table that --help and the docs are generated from.
std::span<const ExitCodeMeaning> exit_codes();

class Error : public std::runtime_error {
public:
    Error(ExitCode exit_code, std::string_view where, std::string_view what);
    ExitCode code;
};

// `where` names the file and field ("scenes/a.json: /lights/0/type"); `what` says what is wrong and what is accepted.
[[noreturn]] void fail(ExitCode code, std::string_view where, std::string_view what);
[[noreturn]] void refuse(std::string_view where, std::string_view what); // invalid input: exit code 3

// Runs `body` and prefixes any Error it throws with `where`.
decltype(auto) within(std::string_view where, const auto& body) {
    try {
        return body();
    } catch (const Error& error) {
        fail(error.code, where, error.what());
    }
}

// Untrusted text made safe for one line of output: control bytes escaped, truncated to `most` bytes.
std::string printable(std::string_view text, size_t most = 200);
}
