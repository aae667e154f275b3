// What every command shares: global options, stopping, checked option values, reports on stdout and lines on stderr.
#pragma once
#include "base/io/progress.h"
#include "base/json/json_values.h"
#include "base/math.h"
#include "base/text.h"
#include "command_line.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
struct Globals {
    ProgressStyle progress = ProgressStyle::automatic;
    bool json = false, quiet = false, verbose = false;
};

// A command's work after the command line was read; returns the exit code.
using Run = std::function<int(const Globals&)>;

Run add_bake(const Command& program);
Run add_render(const Command& program);
Run add_info(const Command& program);
Run add_check(const Command& program);
Run add_modes(const Command& program);
Run add_compare(const Command& program);
Run add_merge(const Command& program);
Run add_submit(const Command& program);
Run add_status(const Command& program);
Run add_verify(const Command& program);
Run add_plan(const Command& program);
Run add_prepare(const Command& program);
Run add_explain(const Command& program);
Run add_stress(const Command& program);
Run add_chart(const Command& program);
Run add_view(const Command& program);

// Becomes the viewer, which reads its own command line. Throws Error when it is not there.
int start_viewer(std::vector<std::string> arguments);

// By steady_seconds, when the program began.
double program_start();

// Set by SIGINT and SIGTERM; long work ends soon after.
std::atomic<bool>& cancel_flag();
// Throws when a signal asked to stop; for work that takes no flag itself.
void stop_if_cancelled();

// What the line about a stop adds for this command: what is kept, and how to go on. A text that lives on.
void set_stop_remark(const char* remark, unsigned seconds_to_stop = 1);
unsigned seconds_to_stop(); // after a signal; then the process ends as it stands
const char* stop_remark();  // empty where nothing is kept

// Runs the program's work and gives the exit code; an exception becomes a line on stderr. Nothing is said of an error
// that a signal has caused.
int exit_code_of(const std::function<int()>& work);

// Whether an error also becomes an openjd_fail line on stdout.
void report_failure_to_openjd(bool wanted);

// One line for people on stderr; foreign text in it has to be printable already.
void say(std::string_view line);
// The data a command was asked for, on stdout. Throws Error (unwritable); a reader that has gone away is no error.
void print_report(std::string_view text);

// An option's value as a number in low..high. Throws Error (usage) naming the option.
int64_t integer_option(std::string_view option, std::string_view text, int64_t low, int64_t high);
int frame_option(std::string_view text); // of --frame
double number_option(std::string_view option, std::string_view text, double low, double high);
// WIDTHxHEIGHT in pixels, each up to largest_side.
inline constexpr int largest_side = 16384; // what EXR readers take
ivec2 resolution_option(std::string_view option, std::string_view text);
// Sets the instruction set of all kernels. Returns the one the bits depend on: avx2 unless another was asked for, since
// the vector kernels round alike on avx2 and avx512 and the ray tracer takes avx2 by itself.
std::string chosen_isa(const std::string& text);
// The fastest that gives the bits of a plan's. Throws Error (usage) where this machine lacks it.
void use_planned_isa(const std::string& planned);
// The pieces between commas.
std::vector<std::string> comma_list(std::string_view text);
}
