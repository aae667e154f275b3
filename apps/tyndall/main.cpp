// The program `tyndall`: reads the command line, runs one command, turns every outcome into an exit code.
#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "common.h"

#include <csignal>
#include <cstdio>
#include <new>

#include <fcntl.h>
#include <unistd.h>

namespace tyndall {
namespace {
volatile std::sig_atomic_t stop_signal = 0;
constexpr unsigned seconds_to_stop = 1; // after a signal; then the process ends as it stands

// The first signal asks the work to stop, the second one ends the process at once.
extern "C" void on_stop(int signal) {
    if (stop_signal) _exit(128 + signal);
    stop_signal = signal;
    cancel_flag() = true;
    alarm(seconds_to_stop);
}

// The work did not stop in time. What it was writing keeps its temporary name, which the next run removes.
extern "C" void on_alarm(int) {
    constexpr char line[] = "tyndall: stopped; finished files are kept, --resume continues\n";
    if (write(STDERR_FILENO, line, sizeof line - 1) < 0) _exit(128 + stop_signal);
    _exit(128 + stop_signal);
}

void handle_signals() {
    std::signal(SIGPIPE, SIG_IGN); // a closed pipe and a file over the size limit are errors of the write
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGALRM, on_alarm);
    std::signal(SIGINT, on_stop);
    std::signal(SIGTERM, on_stop);
}

// A program started with a closed stdin, stdout or stderr must not have a picture take its place.
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

constexpr const char* exit_codes =
    R"(Exit codes: 0 done, 1 problems found (check), a limit exceeded (compare), a larger error than wanted (render),
no mode that gets there (plan), a proof that failed (verify) or a mode that fails in silence (stress), 2 wrong
command line, 3 input refused, 4 input missing or unreadable, 5 output could not be written, 6 done but some samples
or pixels were not finite numbers, 33 out of memory, 70 internal error, 128+n stopped by signal n.)";

struct GlobalTexts {
    std::string threads, progress;
};

void add_globals(CLI::App& app, Globals& globals, GlobalTexts& texts) {
    const auto group = [](CLI::Option* option) { option->group("For every command"); };
    group(app.set_help_flag("-h,--help", "explain a command and its options"));
    group(app.set_version_flag("--version", "tyndall " TYNDALL_VERSION, "print the version"));
    group(
        app.add_option("--threads", texts.threads, "threads to use, 1 to 1024 (default: every core)")->type_name("N"));
    group(app.add_option("--progress", texts.progress,
                         "how progress is shown: alf (ALF_PROGRESS lines for render farms), json,\n"
                         "bar, none (default: bar on a terminal, alf elsewhere)")
              ->type_name("STYLE"));
    group(app.add_flag("--json", globals.json, "report as JSON on stdout; progress goes to stderr"));
    group(app.add_flag("-q,--quiet", globals.quiet, "errors only: no progress, no remarks, no list of finished files"));
    group(app.add_flag("-v,--verbose", globals.verbose, "say more: threads, files read, remarks"));
}

void apply_globals(Globals& globals, const GlobalTexts& texts) {
    const std::vector<std::string> styles{"alf", "json", "bar", "none"};
    constexpr ProgressStyle values[] = {ProgressStyle::alf, ProgressStyle::json, ProgressStyle::bar,
                                        ProgressStyle::none};
    if (!texts.progress.empty()) globals.progress = values[choice_option("--progress", texts.progress, styles)];
    if (globals.quiet && (texts.progress.empty() || globals.progress == ProgressStyle::none))
        globals.progress = ProgressStyle::silent;
    set_thread_count(texts.threads.empty() ? 0 : static_cast<int>(integer_option("--threads", texts.threads, 1, 1024)));
}

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    }
    return names;
}

// "; did you mean --frames?" when a name is near enough to be meant.
std::string hint(std::string_view typed, const std::vector<std::string>& names) {
    const std::string nearest = nearest_name(typed, names);
    const size_t start = nearest.find_first_not_of('-');
    const bool alike = start != nearest.npos && typed.size() > start && typed[start] == nearest[start];
    return alike ? "; did you mean " + nearest + "?" : "";
}

// The reader's own words, except where they are hard to understand.
std::string reworded(const CLI::ParseError& error) {
    const std::string text = printable(error.what(), 300);
    if (error.get_name() != "ArgumentMismatch") return text;
    const std::string option = text.substr(0, text.find(':'));
    return option + (text.find("received") != text.npos ? ": given more than once" : ": a value is missing");
}

// What the command line reader stumbled over, in one line.
std::string parse_problem(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    const std::string help = (chosen.empty() ? "" : " " + chosen[0]->get_name()) + " --help";
    for (const std::string& argument : app.remaining(true)) {
        if (argument.size() > 1 && argument[0] == '-') {
            std::vector<std::string> names = option_names(app);
            for (const CLI::App* command : chosen)
                for (const std::string& name : option_names(*command)) names.push_back(name);
            const std::string_view typed = std::string_view(argument).substr(0, argument.find('='));
            return "unknown option '" + printable(typed, 60) + "'" + hint(typed, names) + " (tyndall" + help + ")";
        }
        if (chosen.empty()) {
            std::vector<std::string> names;
            for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
            return "unknown command '" + printable(argument, 60) + "'" + hint(argument, names) + " (tyndall --help)";
        }
        return "unexpected '" + printable(argument, 60) + "' (tyndall" + help + ")";
    }
    return reworded(error) + " (tyndall" + help + ")";
}

// An empty value is most often a variable a script forgot to set; it must not count as "not given".
void refuse_empty_values(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options())
        for (const std::string& value : option->results())
            if (value.empty()) fail(ExitCode::usage, option->get_name(), "the value is empty");
    for (const CLI::App* command : app.get_subcommands()) refuse_empty_values(*command);
}

int run(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "view") return start_viewer({argv + 2, argv + argc});
    CLI::App app{"Tyndall bakes fog, lights it and renders it: OpenVDB in, OpenEXR out.", "tyndall"};
    app.get_formatter()->column_width(28);
    app.get_formatter()->label("Positionals", "What");
    app.get_formatter()->label("REQUIRED", "(required)");
    app.get_formatter()->label("SUBCOMMAND", "COMMAND");
    app.require_subcommand(0, 1);
    app.footer(exit_codes);
    Globals globals;
    GlobalTexts texts;
    add_globals(app, globals, texts);
    const std::vector<Run> commands{add_bake(app),    add_render(app),  add_info(app),   add_check(app),
                                    add_modes(app),   add_compare(app), add_verify(app), add_plan(app),
                                    add_explain(app), add_stress(app),  add_chart(app),  add_view(app)};
    const std::vector<CLI::App*> names = app.get_subcommands({});
    for (CLI::App* command : names) {
        command->fallthrough()->group("Commands");
        command->footer(command->get_footer() +
                        "\nFor every command: --threads N, --progress STYLE, --json, -q, -v (tyndall --help).");
    }

    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        print_report(app.help());
        return 0;
    } catch (const CLI::CallForVersion& version) {
        print_report(std::string(version.what()) + "\n");
        return 0;
    } catch (const CLI::ParseError& error) {
        fail(ExitCode::usage, "", parse_problem(app, error));
    }
    refuse_empty_values(app);
    apply_globals(globals, texts);
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i]->parsed()) return commands[i](globals);
    print_report(introduction);
    return 0;
}

int report_error(std::string_view text, ExitCode code) {
    say("error: " + printable(text, 480));
    return static_cast<int>(code);
}
}
}

int main(int argc, char** argv) {
    using namespace tyndall;
    flush_denormals();
    open_standard_streams();
    handle_signals();
    int code = 0;
    try {
        code = run(argc, argv);
    } catch (const Error& error) {
        if (!stop_signal) return report_error(error.what(), error.code);
    } catch (const std::bad_alloc&) {
        return report_error("out of memory: fewer pixels, coarser voxels or a machine with more memory help",
                            ExitCode::out_of_memory);
    } catch (const std::exception& error) {
        if (!stop_signal) return report_error("internal: " + std::string(error.what()), ExitCode::internal);
    }
    if (!stop_signal) return code;
    say(formatted("stopped by signal %d; finished files are kept, --resume continues", static_cast<int>(stop_signal)));
    return 128 + stop_signal;
}
