// tyndall stress: runs the stress suite, each mode on each case.
#include "base/clock.h"
#include "base/error.h"
#include "base/io/file.h"
#include "base/io/output.h"
#include "measuring/stress_report.h"
#include "measuring/stress_resume.h"
#include "modes/mode.h"

namespace tyndall {
namespace {
struct Options {
    std::string modes, cases, output;
    bool list = false, resume = false;
};

std::vector<Mode> chosen_modes(const std::string& names) {
    if (names.empty()) return {modes().begin(), modes().end()};
    std::vector<Mode> chosen;
    for (const std::string& name : comma_list(names)) chosen.push_back(find_mode(name));
    return chosen;
}

// The cases whose name or group contains one of the comma-separated patterns.
std::vector<const StressCase*> chosen_cases(const std::string& patterns) {
    std::vector<const StressCase*> chosen;
    for (const StressCase& stress : stress_cases()) {
        bool wanted = patterns.empty();
        for (const std::string& part : comma_list(patterns))
            wanted |=
                stress.id.find(part) != std::string_view::npos || stress.group.find(part) != std::string_view::npos;
        if (wanted) chosen.push_back(&stress);
    }
    if (chosen.empty())
        fail(ExitCode::usage, "--cases",
             "no case or group has '" + printable(patterns, 60) + "' in its name (--list shows them)");
    return chosen;
}

// Those of `cases` that at least one of the modes takes part in, or that test the program as a whole.
std::vector<const StressCase*> cases_for(std::span<const Mode> chosen, std::vector<const StressCase*> cases) {
    std::erase_if(cases, [&](const StressCase* stress) {
        const auto takes = [&](const Mode& mode) { return takes_part(*stress, mode); };
        return !stress->modes.program() && std::ranges::none_of(chosen, takes);
    });
    return cases;
}

std::vector<std::string> columns(const std::vector<StressResult>& results) {
    std::vector<std::string> names;
    const auto took = [&](std::string_view name) {
        return std::ranges::any_of(results, [&](const StressResult& result) { return result.mode == name; });
    };
    for (const Mode& mode : modes())
        if (took(mode.name)) names.emplace_back(mode.name);
    if (took("program")) names.emplace_back("program");
    return names;
}

void write_files(const std::filesystem::path& directory, const StressReport& report) {
    write_file_atomically(directory / "stress.txt", stress_text(report));
    write_file_atomically(directory / "stress.json", stress_json(report));
    write_file_atomically(directory / "stress.html", stress_html(report));
}

// Runs the cases one by one; with an output folder, updates the reports there after each.
StressReport run_cases(std::span<const StressCase* const> cases, std::span<const Mode> chosen, const Options& args,
                       Progress& progress) {
    const std::filesystem::path directory = args.output;
    const EarlierStress earlier = args.resume ? earlier_stress(directory / "stress.json") : EarlierStress();
    const double start = steady_seconds();
    StressReport report;
    report.asked = cases.size();
    for (size_t i = 0; i < cases.size(); ++i) {
        std::vector<StressResult> results = kept_results(earlier, *cases[i], chosen);
        const bool kept = !results.empty();
        if (!kept) results = run_stress(*cases[i], chosen, &cancel_flag());
        stop_if_cancelled();
        report.results.insert(report.results.end(), results.begin(), results.end());
        report.modes = columns(report.results);
        report.seconds = steady_seconds() - start;
        if (!args.output.empty() && (!kept || i + 1 == cases.size())) write_files(directory, report);
        progress.set(static_cast<double>(i + 1) / static_cast<double>(cases.size()));
    }
    return report;
}

int run(const Options& args, const Globals& globals) {
    const std::vector<Mode> chosen = chosen_modes(args.modes);
    const std::vector<const StressCase*> cases = cases_for(chosen, chosen_cases(args.cases));
    if (cases.empty()) fail(ExitCode::usage, "--modes", "none of these modes takes part in the chosen cases");
    if (args.list) {
        print_report(stress_list(cases));
        return 0;
    }
    if (args.resume && args.output.empty()) fail(ExitCode::usage, "--resume", "needs --output");
    OutputPaths places;
    if (!args.output.empty()) {
        set_stop_remark("; finished cases are kept, --resume continues");
        for (const char* name : {"stress.txt", "stress.json", "stress.html"})
            places.check(std::filesystem::path(args.output) / name);
    }

    Progress progress(globals.progress, "stress", 1, globals.json);
    const StressReport report = run_cases(cases, chosen, args, progress);
    progress.finish();
    print_report(globals.json ? stress_json(report) : stress_text(report));
    return static_cast<int>(report.count(Verdict::fails) ? ExitCode::differs : ExitCode::ok);
}
}

Run add_stress(const Command& program) {
    const Command command = program.command("stress", "test where each mode fails, and whether it warns");
    auto args = std::make_shared<Options>();
    command.option("--modes", args->modes, "which modes, comma-separated (default: all)", "NAMES");
    command.option("--cases", args->cases,
                   "cases with one of these in their name or group, comma-separated\n(default: all)", "PARTS");
    command.option("-o,--output", args->output,
                   "folder for stress.txt, stress.json and stress.html, updated case by case", "DIR");
    command.flag("--resume", args->resume, "keep the cases that are already in stress.json in the output folder");
    command.flag("--list", args->list, "only list the cases and what they sweep");
    command.footer("Examples: everything, in some minutes; then one mode's shadows\n"
                   "  tyndall stress -o out/stress\n"
                   "  tyndall stress --modes shadow-map --cases shadows\n"
                   "Each case is a tiny scene in which one condition goes from mild to hard. A mode holds, degrades\n"
                   "from some value on with a warning beforehand (tyndall render gives it too), or fails silently.\n"
                   "Exit code 0: none fails silently; 1: one does.");
    return [args](const Globals& globals) { return run(*args, globals); };
}
}
