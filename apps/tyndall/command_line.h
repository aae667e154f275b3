// A program's command line: commands, options and flags, read into text. The only user of CLI11, whose header costs
// seconds to compile.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}

namespace tyndall {
// Handle to a declared option.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}
    Option required() const;
    Option group(const char* heading) const; // its section of the help text

private:
    CLI::Option* option_;
};

// A command, or the program itself. Names are "NAME" (positional), "--name" or "-n,--name"; type is the value's name in
// the help text, "" for none. Values must outlive the reading of the command line.
class Command {
public:
    explicit Command(CLI::App* app) : app_(app) {}
    Option option(const char* names, std::string& value, const char* help, const char* type) const;
    Option options(const char* names, std::vector<std::string>& values, const char* help, const char* type) const;
    Option flag(const char* names, bool& value, const char* help) const;
    void footer(const std::string& text) const; // ends the help text
    void pass_on() const;                       // leaves the arguments after its name unparsed
    std::vector<std::string> passed_on() const;
    Command command(const char* name, const char* summary) const;

protected:
    CLI::App* app_;
};

// The whole command line; adds -h, --help and --version, listed in the help text under `group`.
class CommandLine : public Command {
public:
    CommandLine(const char* name, const char* summary, const std::string& version, const char* group);
    ~CommandLine();
    void end_every_footer(const std::string& text) const; // of the commands added so far
    // Returns false after printing help or the version on request. Throws Error (usage) with a one-line message; for an
    // unknown name it suggests the nearest one.
    bool read(int argc, char** argv) const;
    // Index of the given command, in the order they were added; nullopt when none was given.
    std::optional<size_t> chosen() const;

private:
    std::unique_ptr<CLI::App> whole_;
};
}
