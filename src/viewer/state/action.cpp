#include "viewer/state/action.h"

#include "base/error.h"
#include "base/text.h"

namespace tyndall {
// Parameters: a word in capitals is a name; x, y, z, n, ev, factor and degrees are numbers; X,Y is a point; [] marks
// optional ones; a|b is one of these words.
const std::vector<VerbInfo>& verbs() {
    static const std::vector<VerbInfo> all{
        {Verb::open, "open", "FILE", "open another scene"},
        {Verb::reload, "reload", "",
         "reload all files; unsaved edits are kept (changed files are reloaded automatically)"},
        {Verb::set, "set", "NAME VALUE", "change a setting, as --set does"},
        {Verb::reset, "reset", "NAME", "reset a setting to its default; all: every setting"},
        {Verb::mode, "mode", "NAME", "render with another technique"},
        {Verb::beside, "beside", "[NAME]",
         "show another technique, or the reference, in the right part of the image; no name: none"},
        {Verb::wipe, "wipe", "x", "where that part begins, as a fraction of the width"},
        {Verb::arrange, "arrange", "wipe|side", "show the two in one image with a wipe, or side by side"},
        {Verb::explain, "explain", "[x] [y]",
         "show what happens along the ray of a pixel (0 0: upper left) and the result of every technique; no pixel: "
         "close"},
        {Verb::volume, "volume", "on|off", "show a medium's density and facts about its grid"},
        {Verb::medium, "medium", "NAME", "the medium to show"},
        {Verb::slice, "slice", "x|y|z n", "show its density across an axis, at a fraction of its extent"},
        {Verb::project, "project", "x|y|z maximum|mean", "show its maximum or mean density along an axis"},
        {Verb::quality, "quality", "NAME", "set all settings to draft, preview, final or reference"},
        {Verb::orders, "orders", "NAME", "orders of scattering: a number, or all"},
        {Verb::show, "show", "NAME",
         "picture, fog, transmittance, depth, validity, stops (false colors) or error (against the "
         "reference)"},
        {Verb::exposure, "exposure", "EV",
         "exposure of the displayed image, in stops; auto: measured; scene: the scene's"},
        {Verb::brighten, "brighten", "ev", "raise the exposure by that many stops"},
        {Verb::view_transform, "view-transform", "filmic|srgb", "how values brighter than the display are shown"},
        {Verb::zoom, "zoom", "NAME [x] [y]",
         "fit: the whole image; 1, 2 ...: window pixels per image pixel, centered on pixel x y"},
        {Verb::camera, "camera", "[NAME]",
         "switch to a camera of the scene, as placed in the scene; no name: the default camera"},
        {Verb::orbit, "orbit", "x y", "orbit around the point looked at, degrees"},
        {Verb::turn, "turn", "x y", "turn the camera in place, degrees"},
        {Verb::pan, "pan", "x y", "pan the view, in image heights"},
        {Verb::dolly, "dolly", "factor", "multiply the distance to the point looked at by a factor"},
        {Verb::fly, "fly", "x y z", "move the camera right, up and forward, meters"},
        {Verb::size, "size", "x y", "image size in pixels; 0 0: the scene's"},
        {Verb::frame, "frame", "n", "go to a frame"},
        {Verb::step, "step", "n", "go n frames forward"},
        {Verb::play, "play", "[n]", "play, or play n frames"},
        {Verb::stop, "stop", "", "stop playing"},
        {Verb::loop, "loop", "on|off", "restart at the end when playing"},
        {Verb::edit, "edit", "PATH VALUE [n]",
         "change a value at this frame, such as lights/lamp/intensity 400; edits with the same n undo as one step"},
        {Verb::undo, "undo", "", "undo the last edit of the scene"},
        {Verb::redo, "redo", "", "redo the edit that was undone"},
        {Verb::cancel, "cancel", "n", "undo the edits with number n, without redo"},
        {Verb::save, "save", "", "write the edits into the scene file"},
        {Verb::save_as, "save-as", "FILE", "write a new scene file and continue with it"},
        {Verb::select, "select", "PATH", "show the editable values of lights/NAME, media/NAME, cameras/NAME or scene"},
        {Verb::tab, "tab", "NAME", "page of the side panel: render or lights"},
        {Verb::handles, "handles", "on|off", "draw handles in the image for moving lights"},
        {Verb::missing, "missing", "error|hold|skip",
         "missing frames of a volume sequence: show an error, hold the frame before, or skip the fog"},
        {Verb::panels, "panels", "on|off", "show the panels"},
        {Verb::help, "help", "on|off", "show keys and mouse controls"},
        {Verb::key, "key", "NAME", "press a key"},
        {Verb::drag, "drag", "X,Y X,Y", "move the mouse from one point of the window to another, left button down"},
        {Verb::wait, "wait", "NAME [n]",
         "wait until idle, until a job ends, for this many seconds, or for \"samples N\""},
        {Verb::snapshot, "snapshot", "FILE", "write the image as tyndall render does: .exr or .png"},
        {Verb::screenshot, "screenshot", "FILE", "write the window as it is: .png"},
        {Verb::render, "render", "FILE [RANGE] [exr|png]",
         "render frames to out.####.exr in the background, as tyndall render does; png: PNGs as well"},
        {Verb::bake, "bake", "NAME FILE [RANGE]", "bake the recipe of a medium to out.####.vdb, as tyndall bake does"},
        {Verb::stop_job, "stop-job", "", "stop the job; finished frames are kept when it is started again"},
        {Verb::copy_command, "copy-command", "FILE [RANGE] [exr|png]",
         "copy the command line that renders the same frames to the clipboard"},
        {Verb::close, "close", "",
         "close the window as its button does; asks if edits are unsaved or a job is running"},
        {Verb::answer, "answer", "NAME", "answer that question: save, discard or cancel"},
        {Verb::quit, "quit", "", "quit without asking"},
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

double number(std::string_view text, const std::string& location, std::string_view usage) {
    const auto value = parsed<double>(text);
    if (!value || !(std::abs(*value) <= largest_number))
        refuse(location, "'" + printable(text, 40) + "' is not a number; expected " + std::string(usage));
    return *value;
}

bool is_name(std::string_view parameter) { return parameter[0] >= 'A' && parameter[0] <= 'Z' && parameter != "X,Y"; }

void add_point(Action& action, std::string_view word, std::string_view usage) {
    const size_t comma = word.find(',');
    if (comma == word.npos)
        refuse(action.location, "'" + printable(word, 40) + "' is not a point; expected " + std::string(usage));
    action.numbers.push_back(number(word.substr(0, comma), action.location, usage));
    action.numbers.push_back(number(word.substr(comma + 1), action.location, usage));
}

void add_parameter(Action& action, std::string_view parameter, const std::string& word, std::string_view usage) {
    if (parameter == "X,Y") return add_point(action, word, usage);
    if (parameter.find('|') != parameter.npos) {
        if (word.empty() || ("|" + std::string(parameter) + "|").find("|" + word + "|") == std::string::npos)
            refuse(action.location, "expected " + std::string(usage) + ", got '" + printable(word, 40) + "'");
        action.words.push_back(word);
    } else if (is_name(parameter)) {
        action.words.push_back(word);
    } else {
        action.numbers.push_back(number(word, action.location, usage));
    }
}

// Checks wait, the only verb whose first word determines what follows.
void check_wait(const Action& action) {
    const std::string& what = action.words[0];
    const bool samples = what == "samples";
    constexpr const char* usage = "wait idle, wait job, wait SECONDS or wait samples N";
    if (samples != (action.numbers.size() == 1)) refuse(action.location, std::string("expected ") + usage);
    if (what != "idle" && what != "job" && !samples && number(what, action.location, usage) < 0)
        refuse(action.location, "seconds cannot be negative");
}
}

Action parse_action(std::string_view text, const std::string& location) {
    const Line line = split(text);
    const auto& words = line.words;
    if (words.empty()) refuse(location, "no action given");
    if (line.open_quote) refuse(location, "a closing quote is missing");
    std::vector<std::string> names;
    const VerbInfo* found = nullptr;
    for (const VerbInfo& info : verbs()) {
        names.emplace_back(info.name);
        if (info.name == words[0]) found = &info;
    }
    if (!found) refuse(location, unknown_name("action", words[0], names));

    Action action{found->verb, {}, {}, location};
    const std::string usage =
        std::string(found->name) + (found->parameters.empty() ? "" : " ") + std::string(found->parameters);
    size_t next = 1;
    for (std::string& parameter : split(found->parameters).words) {
        const bool optional = parameter[0] == '[';
        if (optional) parameter = parameter.substr(1, parameter.size() - 2);
        if (next == words.size() && optional) continue;
        if (next == words.size()) refuse(location, "expected " + usage);
        add_parameter(action, parameter, words[next++], usage);
    }
    if (next != words.size())
        refuse(location, "unexpected parameter '" + printable(words[next], 40) + "'; expected " + usage);
    if (action.verb == Verb::wait) check_wait(action);
    if (action.verb == Verb::explain && action.numbers.size() == 1)
        refuse(location, "expected explain x y, or explain");
    if (action.verb == Verb::zoom && action.numbers.size() == 1)
        refuse(location, "expected zoom NAME x y, or zoom NAME");
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
