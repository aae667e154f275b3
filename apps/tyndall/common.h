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

// A command's work once the command line is read; returns the exit code.
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

// Replaces this process with the viewer, which reads its own command line. Throws Error when it is not installed.
int start_viewer(std::vector<std::string> arguments);

// When the program started, on the clock of steady_seconds().
double program_start();

// Set by SIGINT and SIGTERM; long work ends soon after.
std::atomic<bool>& cancel_flag();
// Throws Error after a signal has asked to stop; for work that does not check the flag itself.
void stop_if_cancelled();

// Sets what the message about a stop adds for this command: what is kept and how to continue. Pass a literal: only the
// pointer is stored.
void set_stop_remark(const char* remark, unsigned seconds_to_stop = 1);
unsigned seconds_to_stop(); // grace period from a signal until the process exits as is
const char* stop_remark();  // empty where nothing is kept

// Runs the program's work and returns its exit code; an exception becomes a line on stderr, unless a signal caused it.
int run_program(const std::function<int()>& work);

// Sets whether run_program() also prints an error as an openjd_fail line on stdout.
void report_failure_to_openjd(bool wanted);

// Prints one line for people on stderr; text from files or users must have passed printable().
void say(std::string_view line);
// Prints the data a command was asked for on stdout. Throws Error (unwritable); a closed pipe is not an error.
void print_report(std::string_view text);

// An option's value as a number in low..high. Throws Error (usage) naming the option.
int64_t integer_option(std::string_view option, std::string_view text, int64_t low, int64_t high);
int frame_option(std::string_view text); // of --frame
double number_option(std::string_view option, std::string_view text, double low, double high);
// WIDTHxHEIGHT in pixels, each up to largest_side.
inline constexpr int largest_side = 16384; // the most that read_exr() accepts
ivec2 resolution_option(std::string_view option, std::string_view text);
// Sets the instruction set of all kernels. Returns the one that determines the bits of the result: avx2 unless avx512
// is asked for, since the vector kernels round identically on both and Embree uses avx2 by default.
std::string select_isa(const std::string& text);
// Sets the fastest instruction set with the same bits as the plan's. Throws Error (usage) when this machine lacks it.
void use_planned_isa(const std::string& planned);
// Splits text at its commas.
std::vector<std::string> comma_list(std::string_view text);
}
