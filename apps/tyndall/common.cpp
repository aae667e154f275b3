#include "common.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/simd/isa.h"
#include "base/text.h"
#include "trace/occlusion/occluders.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

namespace tyndall {
namespace {
const double started = steady_seconds();
std::atomic<const char*> remark_of_stop{""};
std::atomic<unsigned> time_to_stop = 1;
bool openjd_hears = false;
}

double program_start() { return started; }

std::atomic<bool>& cancel_flag() {
    static std::atomic<bool> flag{false};
    return flag;
}

void stop_if_cancelled() {
    if (cancel_flag()) fail(ExitCode::internal, "", "stopped");
}

void set_stop_remark(const char* remark, unsigned seconds) { remark_of_stop = remark, time_to_stop = seconds; }
unsigned seconds_to_stop() { return time_to_stop; }
const char* stop_remark() { return remark_of_stop; }

void report_failure_to_openjd(bool wanted) { openjd_hears = wanted; }

int run_program(const std::function<int()>& work) {
    const auto report = [](std::string_view text, ExitCode code) {
        say("error: " + printable(text, 480));
        if (openjd_hears) std::printf("openjd_fail: %s\n", printable(text, 480).c_str());
        return static_cast<int>(code);
    };
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return report("out of memory: use fewer pixels, coarser voxels or a machine with more memory",
                      ExitCode::out_of_memory);
    } catch (const Error& error) {
        if (!cancel_flag()) return report(error.what(), error.code);
    } catch (const std::exception& error) {
        if (!cancel_flag()) return report("internal: " + std::string(error.what()), ExitCode::internal);
    }
    return static_cast<int>(ExitCode::stopped);
}

void say(std::string_view line) { std::fprintf(stderr, "tyndall: %.*s\n", static_cast<int>(line.size()), line.data()); }

void print_report(std::string_view text) {
    errno = 0;
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (written && std::fflush(stdout) == 0) return;
    if (errno != EPIPE) fail(ExitCode::unwritable, "standard output", std::strerror(errno));
}

int64_t integer_option(std::string_view option, std::string_view text, int64_t low, int64_t high) {
    const auto value = parsed<int64_t>(text);
    if (!value || *value < low || *value > high)
        fail(ExitCode::usage, option,
             formatted("expected a whole number from %lld to %lld, got '%s'", static_cast<long long>(low),
                       static_cast<long long>(high), printable(text, 40).c_str()));
    return *value;
}

int frame_option(std::string_view text) { return static_cast<int>(integer_option("--frame", text, -9999999, 9999999)); }

double number_option(std::string_view option, std::string_view text, double low, double high) {
    const auto value = parsed<double>(text);
    if (!value || !(*value >= low && *value <= high))
        fail(ExitCode::usage, option,
             formatted("expected a number from %g to %g, got '%s'", low, high, printable(text, 40).c_str()));
    return *value;
}

ivec2 resolution_option(std::string_view option, std::string_view text) {
    const size_t cross = text.find('x');
    if (cross == text.npos)
        fail(ExitCode::usage, option, "expected WIDTHxHEIGHT, like 1280x720; got '" + printable(text, 40) + "'");
    return {integer_option(option, text.substr(0, cross), 1, largest_side),
            integer_option(option, text.substr(cross + 1), 1, largest_side)};
}

std::string select_isa(const std::string& text) {
    set_isa(text);
    set_embree_isa(text);
    return text == "avx512" ? "avx512" : "avx2";
}

void use_planned_isa(const std::string& planned) { select_isa(planned == "avx512" ? planned : "auto"); }

std::vector<std::string> comma_list(std::string_view text) {
    std::vector<std::string> pieces;
    for (size_t start = 0;;) {
        const size_t comma = text.find(',', start);
        pieces.emplace_back(text.substr(start, comma == text.npos ? text.npos : comma - start));
        if (comma == text.npos) return pieces;
        start = comma + 1;
    }
}
}
