// Parses edits from the words of a script: "lights/lamp/intensity" and "400".
#include "base/error.h"
#include "base/json/json_pointer.h"
#include "base/text.h"
#include "viewer/editing/scene_edit.h"

#include <charconv>

namespace tyndall {
namespace {
std::string_view word_of(Part part) {
    return part == Part::light ? "light" : part == Part::medium ? "medium" : part == Part::camera ? "camera" : "scene";
}

size_t index_of(const Scene& scene, Part part, std::string_view token, std::string_view path) {
    const std::string name = json_pointer_key(token);
    std::vector<size_t> found;
    std::vector<std::string> names;
    for (size_t i = 0; i < count_of(scene, part); ++i) {
        if (name_of(scene, part, i) == name) found.push_back(i);
        names.push_back(name_of(scene, part, i));
    }
    if (found.size() == 1) return found[0];
    if (found.size() > 1)
        fail(ExitCode::usage, path, "several have the name \"" + name + "\"; give its number instead, counted from 0");
    if (token.starts_with('#')) token.remove_prefix(1);
    if (const auto index = parsed<size_t>(token); index && *index < names.size()) return *index;
    fail(ExitCode::usage, path, unknown_name(word_of(part), name, names));
}

Part part_of(std::string_view list) {
    return list == "lights"    ? Part::light
           : list == "media"   ? Part::medium
           : list == "cameras" ? Part::camera
                               : Part::scene;
}

std::vector<float> numbers_in(std::string_view text, std::string_view path) {
    std::vector<float> numbers;
    while (!text.empty()) {
        if (std::string_view(" ,[]\t").find(text.front()) != std::string_view::npos) {
            text.remove_prefix(1);
            continue;
        }
        float value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc()) fail(ExitCode::usage, path, "\"" + std::string(text) + "\" is not a number");
        numbers.push_back(value);
        text.remove_prefix(end - text.data());
    }
    return numbers;
}

vec3 parsed_value(const Property& property, std::string_view text, std::string_view path) {
    if (property.kind == ValueKind::toggle) {
        if (text == "on" || text == "true" || text == "1") return vec3(1, 0, 0);
        if (text == "off" || text == "false" || text == "0") return vec3(0);
        fail(ExitCode::usage, path, "expected on or off");
    }
    const std::vector<float> numbers = numbers_in(text, path);
    if (numbers.size() == 3 && property.kind != ValueKind::number) return {numbers[0], numbers[1], numbers[2]};
    if (numbers.size() == 1) return property.kind == ValueKind::number ? vec3(numbers[0], 0, 0) : vec3(numbers[0]);
    fail(ExitCode::usage, path, property.kind == ValueKind::number ? "takes one number" : "takes three numbers or one");
}
}

PartRef parse_part(const Scene& scene, std::string_view path) {
    if (path == "scene") return {Part::scene, 0};
    const size_t slash = path.find('/');
    const Part part = part_of(path.substr(0, slash));
    if (part == Part::scene || slash == path.npos)
        fail(ExitCode::usage, path, "expected lights/NAME, media/NAME, cameras/NAME or scene");
    return {part, index_of(scene, part, path.substr(slash + 1), path)};
}

Edit parse_edit(const Scene& scene, std::string_view path, std::string_view value, double seconds) {
    Edit edit;
    edit.seconds = seconds;
    const size_t first = path.find('/'), second = path.find('/', first + 1);
    const std::string_view list = path.substr(0, first);
    edit.part = part_of(list);
    edit.property = path;
    if (edit.part != Part::scene) {
        if (first == path.npos || second == path.npos)
            fail(ExitCode::usage, path, "needs a name and a property: " + std::string(list) + "/name/property");
        edit.index = index_of(scene, edit.part, path.substr(first + 1, second - first - 1), path);
        edit.property = path.substr(second + 1);
    }
    edit.value = parsed_value(find_property(scene, edit.part, edit.index, edit.property), value, path);
    return edit;
}
}
