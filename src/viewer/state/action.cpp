#include "viewer/state/action.h"

#include "base/error.h"
#include "base/text.h"

namespace tyndall {
// Parameters: a word in capitals is a name; x, y, z, n, ev, factor and degrees are numbers; X,Y is a point; [] marks
// optional ones; a|b is one of these words.
const std::vector<VerbInfo>& verbs() {
    static const std::vector<VerbInfo> all{
        {Verb::open, "open", "FILE", "show another scene"},
        {Verb::reload, "reload", "",
         "read all files again; unsaved edits stay (files that change are read by themselves)"},
        {Verb::set, "set", "NAME VALUE", "change a setting, as --set does"},
        {Verb::reset, "reset", "NAME", "a setting back to its usual value; all: every one"},
        {Verb::mode, "mode", "NAME", "render with another technique"},
        {Verb::beside, "beside", "[NAME]",
         "another technique, or the reference, in the right part of the image; without a name: none"},
        {Verb::wipe, "wipe", "x", "where that part begins, as a share of the width"},
        {Verb::arrange, "arrange", "wipe|side", "two techniques in one image, or in two images side by side"},
        {Verb::explain, "explain", "[x] [y]",
         "what happens on the ray of a pixel, 0 0 the upper left, and what every technique makes of it; without: "
         "close"},
        {Verb::volume, "volume", "on|off", "show a medium's density and what is known of its grid"},
        {Verb::medium, "medium", "NAME", "which medium that is"},
        {Verb::slice, "slice", "x|y|z n", "its density across an axis, at a share of its extent"},
        {Verb::project, "project", "x|y|z maximum|mean", "its largest or mean density along an axis"},
        {Verb::quality, "quality", "NAME", "all settings as draft, preview, final or reference have them"},
        {Verb::orders, "orders", "NAME", "how many times light scatters: a number, or all"},
        {Verb::show, "show", "NAME",
         "picture, fog, transmittance, depth, validity, stops (false colours) or error: against the "
         "reference"},
        {Verb::exposure, "exposure", "EV",
         "how much brighter the image is shown than light is, in stops; auto: measured; scene: as the scene states"},
        {Verb::brighten, "brighten", "ev", "that many stops more"},
        {Verb::view_transform, "view-transform", "filmic|srgb", "how what is brighter than a screen is shown"},
        {Verb::zoom, "zoom", "NAME [x] [y]",
         "fit: the whole image; 1, 2 ...: so many pixels of the window for one of it, that of x y in the middle"},
        {Verb::camera, "camera", "[NAME]", "a camera of the scene, back where it stands; without a name: the scene's"},
        {Verb::orbit, "orbit", "x y", "turn the scene around the point looked at, degrees"},
        {Verb::turn, "turn", "x y", "turn the camera where it stands, degrees"},
        {Verb::pan, "pan", "x y", "shift the scene, image heights"},
        {Verb::dolly, "dolly", "factor", "the distance to the point looked at, times a factor"},
        {Verb::fly, "fly", "x y z", "metres to the right, up, forward"},
        {Verb::size, "size", "x y", "image size in pixels; 0 0: the scene's"},
        {Verb::frame, "frame", "n", "go to a frame"},
        {Verb::step, "step", "n", "so many frames on"},
        {Verb::play, "play", "[n]", "play on, or n frames"},
        {Verb::stop, "stop", "", "stop playing"},
        {Verb::loop, "loop", "on|off", "whether playing begins anew at the end"},
        {Verb::edit, "edit", "PATH VALUE [n]",
         "change the scene at this moment, as lights/lamp/intensity 400; with the same n: one step to undo"},
        {Verb::undo, "undo", "", "take back the last edit of the scene"},
        {Verb::redo, "redo", "", "make it again"},
        {Verb::cancel, "cancel", "n", "take back the edits of number n for good"},
        {Verb::save, "save", "", "write the edits into the scene file"},
        {Verb::save_as, "save-as", "FILE", "write a scene file elsewhere and go on with that one"},
        {Verb::select, "select", "PATH",
         "show what can be edited of lights/NAME, media/NAME, cameras/NAME or the scene"},
        {Verb::tab, "tab", "NAME", "what the side shows: render or lights"},
        {Verb::handles, "handles", "on|off", "draw the lights into the image, to be taken hold of"},
        {Verb::missing, "missing", "error|hold|skip",
         "frames that a sequence of volumes lacks: said, the one before shown, or without fog"},
        {Verb::panels, "panels", "on|off", "show the panels"},
        {Verb::help, "help", "on|off", "show what keys and mouse do"},
        {Verb::key, "key", "NAME", "press a key"},
        {Verb::drag, "drag", "X,Y X,Y", "move the mouse from one point of the window to another, left button down"},
        {Verb::wait, "wait", "NAME [n]", "until idle, for a job to end, for so many seconds, or for \"samples N\""},
        {Verb::snapshot, "snapshot", "FILE", "write the image as tyndall render does: .exr or .png"},
        {Verb::screenshot, "screenshot", "FILE", "write the window as it is: .png"},
        {Verb::render, "render", "FILE [RANGE] [exr|png]",
         "frames to files as tyndall render does, out.####.exr, while the viewer goes on; png: pictures as well"},
        {Verb::bake, "bake", "NAME FILE [RANGE]", "a medium grown from a recipe to out.####.vdb, as tyndall bake does"},
        {Verb::stop_job, "stop-job", "", "end that: finished frames stay, and are kept when it is asked for again"},
        {Verb::copy_command, "copy-command", "FILE [RANGE] [exr|png]",
         "to the clipboard: the command line that renders the same frames"},
        {Verb::close, "close", "", "close the window as its button does: asks when edits are unsaved or a job runs"},
        {Verb::answer, "answer", "NAME", "what is to become of them: save, discard or cancel"},
        {Verb::quit, "quit", "", "end without asking"},
    };
    return all;
}

namespace {
struct Line {
    std::vector<std::string> words;
    bool open_quote = false;
};

Line split(std::string_view text) {
    Line line;
    for (size_t i = 0; i < text.size();) {
        if (std::isspace(static_cast<unsigned char>(text[i]))) {
            ++i;
            continue;
        }
        if (text[i] == '#') break;
        const bool quoted = text[i] == '"';
        if (quoted) ++i;
        size_t end = quoted ? text.find('"', i) : text.find_first_of(" \t\r\n\v\f", i);
        if (quoted && end == text.npos) line.open_quote = true;
        end = std::min(end, text.size());
        line.words.emplace_back(text.substr(i, end - i));
        i = end + quoted;
    }
    return line;
}

// The limit for angles, pixels, frames and seconds alike.
constexpr double largest_number = 1e9;

double number(std::string_view text, const std::string& place, std::string_view usage) {
    const auto value = parsed<double>(text);
    if (!value || !(std::abs(*value) <= largest_number))
        refuse(place, "'" + printable(text, 40) + "' is no number; expected " + std::string(usage));
    return *value;
}

bool is_name(std::string_view parameter) { return parameter[0] >= 'A' && parameter[0] <= 'Z' && parameter != "X,Y"; }

void add_point(Action& action, std::string_view word, std::string_view usage) {
    const size_t comma = word.find(',');
    if (comma == word.npos)
        refuse(action.place, "'" + printable(word, 40) + "' is no point; expected " + std::string(usage));
    action.numbers.push_back(number(word.substr(0, comma), action.place, usage));
    action.numbers.push_back(number(word.substr(comma + 1), action.place, usage));
}

void add_parameter(Action& action, std::string_view parameter, const std::string& word, std::string_view usage) {
    if (parameter == "X,Y") return add_point(action, word, usage);
    if (parameter.find('|') != parameter.npos) {
        if (word.empty() || ("|" + std::string(parameter) + "|").find("|" + word + "|") == std::string::npos)
            refuse(action.place, "expected " + std::string(usage) + ", got '" + printable(word, 40) + "'");
        action.words.push_back(word);
    } else if (is_name(parameter)) {
        action.words.push_back(word);
    } else {
        action.numbers.push_back(number(word, action.place, usage));
    }
}

// Checks wait, the only verb whose first word determines what follows.
void check_wait(const Action& action) {
    const std::string& what = action.words[0];
    const bool samples = what == "samples";
    constexpr const char* usage = "wait idle, wait job, wait SECONDS or wait samples N";
    if (samples != (action.numbers.size() == 1)) refuse(action.place, std::string("expected ") + usage);
    if (what != "idle" && what != "job" && !samples && number(what, action.place, usage) < 0)
        refuse(action.place, "seconds cannot be negative");
}
}

Action parse_action(std::string_view text, const std::string& place) {
    const Line line = split(text);
    const auto& words = line.words;
    if (words.empty()) refuse(place, "there is no action here");
    if (line.open_quote) refuse(place, "a quote is left open");
    std::vector<std::string> names;
    const VerbInfo* found = nullptr;
    for (const VerbInfo& info : verbs()) {
        names.emplace_back(info.name);
        if (info.name == words[0]) found = &info;
    }
    if (!found) refuse(place, unknown_name("action", words[0], names));

    Action action{found->verb, {}, {}, place};
    const std::string usage =
        std::string(found->name) + (found->parameters.empty() ? "" : " ") + std::string(found->parameters);
    size_t next = 1;
    for (std::string& parameter : split(found->parameters).words) {
        const bool optional = parameter[0] == '[';
        if (optional) parameter = parameter.substr(1, parameter.size() - 2);
        if (next == words.size() && optional) continue;
        if (next == words.size()) refuse(place, "expected " + usage);
        add_parameter(action, parameter, words[next++], usage);
    }
    if (next != words.size()) refuse(place, "'" + printable(words[next], 40) + "' is one too many; expected " + usage);
    if (action.verb == Verb::wait) check_wait(action);
    if (action.verb == Verb::explain && action.numbers.size() == 1) refuse(place, "expected explain x y, or explain");
    if (action.verb == Verb::zoom && action.numbers.size() == 1) refuse(place, "expected zoom NAME x y, or zoom NAME");
    return action;
}

std::vector<Action> parse_script(std::string_view text, const std::string& file) {
    std::vector<Action> actions;
    int number = 0;
    for (size_t start = 0; start < text.size();) {
        const size_t end = std::min(text.find('\n', start), text.size());
        const std::string_view line = text.substr(start, end - start);
        ++number, start = end + 1;
        if (!split(line).words.empty()) actions.push_back(parse_action(line, file + ":" + std::to_string(number)));
    }
    return actions;
}
}
