#include "command_line.h"

#include "base/error.h"
#include "base/text.h"
#include "common.h"

#include <CLI/CLI.hpp>

namespace tyndall {
namespace {
std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    }
    return names;
}

// "; did you mean --frames?" when a name is close enough to suggest.
std::string hint(std::string_view typed, const std::vector<std::string>& names) {
    const std::string nearest = nearest_name(typed, names);
    const size_t start = nearest.find_first_not_of('-');
    const bool alike = start != nearest.npos && typed.size() > start && typed[start] == nearest[start];
    return alike ? "; did you mean " + nearest + "?" : "";
}

// CLI11's message, reworded where it is hard to understand.
std::string reworded(const CLI::ParseError& error) {
    const std::string text = printable(error.what(), 300);
    if (error.get_name() != "ArgumentMismatch") return text;
    const std::string option = text.substr(0, text.find(':'));
    return option + (text.find("received") != text.npos ? ": given more than once" : ": a value is missing");
}

// Describes the parse error in one line.
std::string parse_problem(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    const std::string program = app.get_name() + " --help";
    const std::string help = chosen.empty() ? program : app.get_name() + " " + chosen[0]->get_name() + " --help";
    for (const std::string& argument : app.remaining(true)) {
        if (argument.size() > 1 && argument[0] == '-') {
            std::vector<std::string> names = option_names(app);
            for (const CLI::App* command : chosen)
                for (const std::string& name : option_names(*command)) names.push_back(name);
            const std::string_view typed = std::string_view(argument).substr(0, argument.find('='));
            return "unknown option '" + printable(typed, 60) + "'" + hint(typed, names) + " (" + help + ")";
        }
        const std::vector<const CLI::App*> commands = app.get_subcommands({});
        if (chosen.empty() && !commands.empty()) {
            std::vector<std::string> names;
            for (const CLI::App* command : commands) names.push_back(command->get_name());
            return "unknown command '" + printable(argument, 60) + "'" + hint(argument, names) + " (" + program + ")";
        }
        return "unexpected '" + printable(argument, 60) + "' (" + help + ")";
    }
    return reworded(error) + " (" + help + ")";
}

constexpr const char* empty_value = "the value is empty";

// Refuses "--name=", which CLI11 would read as "--name" followed by its value.
void refuse_lone_names(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        if (argument == "--") return;
        if (argument.starts_with("--") && argument.find('=') == argument.size() - 1)
            fail(ExitCode::usage, printable(argument.substr(0, argument.size() - 1), 60), empty_value);
    }
}

// An empty value is most often a variable a script forgot to set; it must not count as "not given".
void refuse_empty_values(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options())
        for (const std::string& value : option->results())
            if (value.empty()) fail(ExitCode::usage, option->get_name(), empty_value);
    for (const CLI::App* command : app.get_subcommands()) refuse_empty_values(*command);
}
}

Option Option::required() const {
    option_->required();
    return *this;
}

Option Option::group(const char* heading) const {
    option_->group(heading);
    return *this;
}

Option Command::option(const char* names, std::string& value, const char* help, const char* type) const {
    return Option(app_->add_option(names, value, help)->type_name(type));
}

// A repeated option takes one value per occurrence of its name; only positional values may follow one another.
Option Command::options(const char* names, std::vector<std::string>& values, const char* help, const char* type) const {
    CLI::Option* option = app_->add_option(names, values, help)->type_name(type);
    if (names[0] == '-') option->allow_extra_args(false);
    return Option(option);
}

Option Command::flag(const char* names, bool& value, const char* help) const {
    return Option(app_->add_flag(names, value, help));
}

void Command::footer(const std::string& text) const { app_->footer(text); }
void Command::pass_on() const { app_->prefix_command(); }
std::vector<std::string> Command::passed_on() const { return app_->remaining(); }

Command Command::command(const char* name, const char* summary) const {
    return Command(app_->add_subcommand(name, summary)->fallthrough()->group("Commands"));
}

CommandLine::CommandLine(const char* name, const char* summary, const std::string& version, const char* group)
    : Command(nullptr), whole_(std::make_unique<CLI::App>(summary, name)) {
    app_ = whole_.get();
    app_->get_formatter()->column_width(28);
    app_->get_formatter()->label("Positionals", "What");
    app_->get_formatter()->label("REQUIRED", "(required)");
    app_->get_formatter()->label("SUBCOMMAND", "COMMAND");
    app_->require_subcommand(0, 1);
    app_->set_help_flag("-h,--help", "explain a command and its options")->group(group);
    app_->set_version_flag("--version", version, "print the version")->group(group);
}

CommandLine::~CommandLine() = default;

void CommandLine::end_every_footer(const std::string& text) const {
    for (CLI::App* command : app_->get_subcommands({})) command->footer(command->get_footer() + text);
}

bool CommandLine::read(int argc, char** argv) const {
    refuse_lone_names(argc, argv);
    try {
        app_->parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        print_report(app_->help());
        return false;
    } catch (const CLI::CallForVersion& version) {
        print_report(std::string(version.what()) + "\n");
        return false;
    } catch (const CLI::ParseError& error) {
        fail(ExitCode::usage, "", parse_problem(*app_, error));
    }
    refuse_empty_values(*app_);
    return true;
}

std::optional<size_t> CommandLine::chosen() const {
    const std::vector<CLI::App*> commands = app_->get_subcommands({});
    for (size_t i = 0; i < commands.size(); ++i)
        if (commands[i]->parsed()) return i;
    return std::nullopt;
}
}
