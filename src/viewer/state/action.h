// The actions of the viewer as lines of text, which keys, panels and scripts are all translated to.
#pragma once
#include "base/math.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
enum class Verb {
    open,
    reload,
    set,
    reset,
    mode,
    beside,
    wipe,
    arrange,
    explain,
    volume,
    medium,
    slice,
    project,
    quality,
    orders,
    show,
    exposure,
    brighten,
    view_transform,
    zoom,
    camera,
    orbit,
    turn,
    pan,
    dolly,
    fly,
    size,
    frame,
    step,
    play,
    stop,
    loop,
    edit,
    undo,
    redo,
    cancel,
    save,
    save_as,
    select,
    tab,
    handles,
    missing,
    panels,
    help,
    key,
    drag,
    wait,
    snapshot,
    screenshot,
    render,
    bake,
    stop_job,
    copy_command,
    close,
    answer,
    quit
};

struct Action {
    Verb verb = Verb::quit;
    std::vector<std::string> words; // parameters that are names
    std::vector<double> numbers;    // parameters that are numbers, in order
    std::string location;           // "script.txt:3"; empty outside of scripts
};

struct VerbInfo {
    Verb verb;
    std::string_view name, parameters, doc;
};
const std::vector<VerbInfo>& verbs();

// Parses a line such as "orbit 30 -5". Words with spaces go in double quotes. Throws Error (refused) naming `location`.
Action parse_action(std::string_view line, const std::string& location = {});

// One action per line; a # at the start of a line or after a space begins a comment. Throws Error (refused) naming file
// and line.
std::vector<Action> parse_script(std::string_view text, const std::string& file);
}
