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
// An option as it is declared.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}
    Option required() const;
    Option group(const char* heading) const; // of the help text

private:
    CLI::Option* option_;
};

// A command, or the program itself. Names are "NAME" (by position), "--name" or "-n,--name"; type is what the help text
// calls the value, "" for nothing. Values have to live until the command line was read.
class Command {
public:
    explicit Command(CLI::App* app) : app_(app) {}
    Option option(const char* names, std::string& value, const char* help, const char* type) const;
    Option options(const char* names, std::vector<std::string>& values, const char* help, const char* type) const;
    Option flag(const char* names, bool& value, const char* help) const;
    void footer(const std::string& text) const; // ends the help text
    void pass_on() const;                       // takes whatever comes after its name, unread
    std::vector<std::string> passed_on() const;
    Command command(const char* name, const char* summary) const;

protected:
    CLI::App* app_;
};

// The whole command line; -h, --help and --version are its own, in the group named.
class CommandLine : public Command {
public:
    CommandLine(const char* name, const char* summary, const std::string& version, const char* group);
    ~CommandLine();
    void end_every_footer(const std::string& text) const; // of the commands there are
    // False when help or the version was asked for, and printed. Throws Error (usage) in one line, with the nearest
    // name there is for one that is not.
    bool read(int argc, char** argv) const;
    // Which of the commands was given, counted in the order they were added; none when the program stands alone.
    std::optional<size_t> chosen() const;

private:
    std::unique_ptr<CLI::App> whole_;
};
}
