// The program `tyndall`: reads the command line, runs one command, turns every outcome into an exit code.
#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "common.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>

#include <fcntl.h>
#include <unistd.h>

namespace tyndall {
namespace {
volatile std::sig_atomic_t stop_signal = 0;

// The first signal asks the work to stop, the second one ends the process at once.
extern "C" void on_stop(int signal) {
    if (stop_signal) _exit(128 + signal);
    stop_signal = signal;
    cancel_flag() = true;
    alarm(seconds_to_stop());
}

// The work did not stop in time. A file being written keeps its temporary name; the next run removes it.
extern "C" void on_alarm(int) {
    for (const char* text : {"tyndall: stopped", stop_remark(), "\n"})
        if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
    _exit(128 + stop_signal);
}

void handle_signals() {
    std::signal(SIGPIPE, SIG_IGN); // a closed pipe and an exceeded file size limit become errors of write()
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGALRM, on_alarm);
    std::signal(SIGINT, on_stop);
    std::signal(SIGTERM, on_stop);
}

// Opens /dev/null in place of a closed stdin, stdout or stderr, so that no image file takes its descriptor.
void open_standard_streams() {
    for (int stream = 0; stream <= 2; ++stream)
        if (fcntl(stream, F_GETFD) == -1 && open("/dev/null", O_RDWR) != stream) _exit(70);
}

constexpr const char* introduction = R"(Tyndall bakes fog, lights it and renders it: OpenVDB in, OpenEXR out.

  tyndall bake   volumes/drifting_dust.json -o fog.####.vdb --frames 1-48    make fog from a recipe
  tyndall render scenes/window.json -o out.####.exr --png                    light a scene, render its frames
  tyndall info   fog.0001.vdb                                                what is in a file

tyndall --help lists all commands; tyndall COMMAND --help explains one, with an example.
)";

std::string exit_code_help() {
    std::string text = "Exit codes:\n";
    for (const ExitCodeMeaning& row : exit_codes()) {
        const std::string code = std::to_string(static_cast<int>(row.code));
        const std::string number = row.code == ExitCode::stopped ? code + "+n" : code;
        text += formatted("  %-6s %s\n", number.c_str(), wrapped(row.meaning, 109, 9).c_str());
    }
    return text;
}

struct GlobalArgs {
    std::string threads, progress;
};

constexpr const char* global_group = "For every command";

void add_globals(const Command& program, Globals& globals, GlobalArgs& args) {
    program
        .option("--threads", args.threads,
                "threads to use, 1 to 1024 (default: as many as affinity\nand control group allow)", "N")
        .group(global_group);
    program
        .option("--progress", args.progress,
                "how progress is shown: alf (ALF_PROGRESS lines for render farms), openjd\n"
                "(for Open Job Description), json, bar, none (default: bar on a terminal,\n"
                "alf elsewhere)",
                "STYLE")
        .group(global_group);
    program.flag("--json", globals.json, "report as JSON on stdout; progress goes to stderr").group(global_group);
    program
        .flag("-q,--quiet", globals.quiet,
              "errors only: no remarks, no list of finished files, no progress unless\n--progress is given")
        .group(global_group);
    program.flag("-v,--verbose", globals.verbose, "say more: threads, files read, remarks").group(global_group);
}

void apply_globals(Globals& globals, const GlobalArgs& args) {
    const std::vector<std::string> styles{"alf", "openjd", "json", "bar", "none"};
    constexpr ProgressStyle values[] = {ProgressStyle::alf, ProgressStyle::openjd, ProgressStyle::json,
                                        ProgressStyle::bar, ProgressStyle::none};
    if (!args.progress.empty()) globals.progress = values[choice_among("--progress", args.progress, styles)];
    if (globals.quiet && (args.progress.empty() || globals.progress == ProgressStyle::none))
        globals.progress = ProgressStyle::silent;
    report_failure_to_openjd(globals.progress == ProgressStyle::openjd);
    set_thread_count(args.threads.empty() ? 0 : static_cast<int>(integer_option("--threads", args.threads, 1, 1024)));
    if (globals.verbose && !globals.quiet) say(formatted("threads: %d", thread_count()));
}

// "help COMMAND" means "COMMAND --help".
void read_help(int argc, char** argv) {
    static char flag[] = "--help";
    if (argc < 2 || std::string_view(argv[1]) != "help") return;
    std::rotate(argv + 1, argv + 2, argv + argc);
    argv[argc - 1] = flag;
}

int run(int argc, char** argv) {
    read_help(argc, argv);
    if (argc > 1 && std::string_view(argv[1]) == "view") return start_viewer({argv + 2, argv + argc});
    const CommandLine program("tyndall", "Tyndall bakes fog, lights it and renders it: OpenVDB in, OpenEXR out.",
                              "tyndall " TYNDALL_VERSION, global_group);
    program.footer(exit_code_help());
    Globals globals;
    GlobalArgs args;
    add_globals(program, globals, args);
    const std::vector<Run> commands{
        add_bake(program),    add_render(program),  add_info(program),   add_check(program),
        add_modes(program),   add_compare(program), add_verify(program), add_plan(program),
        add_prepare(program), add_merge(program),   add_submit(program), add_status(program),
        add_explain(program), add_stress(program),  add_chart(program),  add_view(program)};
    program.end_every_footer("\nFor every command: --threads N, --progress STYLE, --json, -q, -v (tyndall --help).");
    if (!program.read(argc, argv)) return 0;
    apply_globals(globals, args);
    if (const std::optional<size_t> chosen = program.chosen()) return commands[*chosen](globals);
    print_report(introduction);
    return 0;
}
}
}

int main(int argc, char** argv) {
    using namespace tyndall;
    flush_denormals();
    open_standard_streams();
    handle_signals();
    const int code = run_program([&] { return run(argc, argv); });
    if (!stop_signal || code == static_cast<int>(ExitCode::out_of_memory)) return code;
    say(formatted("stopped by signal %d%s", static_cast<int>(stop_signal), stop_remark()));
    return static_cast<int>(ExitCode::stopped) + stop_signal;
}
