#include "viewer/editing/scene_text.h"

#include "base/error.h"
#include "base/json/json.h"
#include "base/json/json_pointer.h"
#include "scene/file/scene_words.h"
#include "scene_schema.h"
#include "viewer/editing/json_text.h"
#include "viewer/editing/key_place.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace tyndall {
namespace {
bool is_gray(vec3 value) { return value.x == value.y && value.y == value.z; }

std::string value_text(const Property& property, vec3 value) {
    if (property.kind == ValueKind::toggle) return value.x != 0 ? "true" : "false";
    if (property.kind == ValueKind::number) return json_number(value.x);
    return property.kind == ValueKind::color && is_gray(value) ? json_number(value.x) : list_text(value);
}

Json json_at(std::string_view text, std::string_view pointer) {
    return parse_json(find_json(text, pointer)->of(text), pointer);
}

// A number keeps its digits if they already give the value.
void write_number(std::string& text, const std::string& pointer, float value) {
    const Json old = json_at(text, pointer);
    if (old.kind == Json::Kind::number && static_cast<float>(old.number) == value) return;
    text = with_json(text, pointer, json_number(value));
}

// Replaces a constant value.
void write_value(std::string& text, const std::string& pointer, const Property& property, vec3 value) {
    const Json old = json_at(text, pointer);
    const bool gray = old.kind == Json::Kind::number && is_gray(value);
    if (property.kind == ValueKind::number || (property.kind != ValueKind::toggle && gray))
        return write_number(text, pointer, value.x);
    if (old.kind != Json::Kind::array) {
        const bool list = property.kind != ValueKind::toggle && !gray;
        text = with_json(text, pointer, list ? list_text(value) : value_text(property, value));
        return;
    }
    for (int i = 0; i < 3; ++i) write_number(text, json_pointer(pointer, static_cast<size_t>(i)), value[i]);
}

vec3 color_of(const Json& json) {
    if (json.kind == Json::Kind::number) return vec3(static_cast<float>(json.number));
    return {static_cast<float>(json.items[0].number), static_cast<float>(json.items[1].number),
            static_cast<float>(json.items[2].number)};
}

// Writes to an animated value what scene_edit.cpp does to its keys in memory.
void write_key(std::string& text, const std::string& pointer, const Property& property, const Edit& edit,
               double frame_rate) {
    const Json keyed = json_at(text, pointer);
    const std::vector<Json>& keys = keyed.find("keys")->items;
    std::vector<float> times;
    for (const Json& key : keys) times.push_back(static_cast<float>(key.items[0].number));
    const KeyLookup place = find_key(times, keyed.boolean_or("loop", false), edit.seconds, frame_rate);
    const std::string list = pointer + "/keys";
    if (!place.exists) {
        const std::string key = "[" + json_number(place.time) + ", " + value_text(property, edit.value) + "]";
        text = with_json_item(text, list, place.index, key);
        return;
    }
    if (place.seam && color_of(keys.front().items[1]) == color_of(keys.back().items[1]))
        write_value(text, json_pointer(list, keys.size() - 1) + "/1", property, edit.value);
    write_value(text, json_pointer(list, place.index) + "/1", property, edit.value);
}

// Appends an entry to a list in the root, on its own line if the text has several lines.
std::string add_entry(std::string& text, const char* list, const std::string& entry) {
    const std::string pointer = "/" + std::string(list);
    const std::string indent = indentation_of(text), line = line_end_of(text);
    if (const auto span = find_json(text, pointer)) {
        const size_t count = parse_json(span->of(text), pointer).items.size();
        text = with_json_item(text, pointer, count, entry);
        return json_pointer(pointer, count);
    }
    text = with_json(text, pointer,
                     indent.empty() ? "[" + entry + "]" : "[" + line + indent + indent + entry + line + indent + "]");
    return pointer + "/0";
}

struct Writer {
    std::string& text;
    const Scene& scene;
    std::vector<std::string> lights, cameras; // the JSON pointer of each in the text; empty = not there yet

    Writer(std::string& to, const Scene& from) : text(to), scene(from) {
        for (const LightSource& light : scene.lights) lights.push_back(light.entry);
        for (const CameraSource& camera : scene.cameras) cameras.push_back(camera.entry);
    }

    std::string entry_of(const Edit& edit) {
        if (edit.part == Part::scene) return "";
        if (edit.part == Part::medium) return scene.media[edit.index].entry;
        std::string& entry = edit.part == Part::light ? lights[edit.index] : cameras[edit.index];
        if (!entry.empty()) return entry;
        if (edit.part == Part::light)
            return entry = add_entry(text, "lights", "{ \"name\": " + quote_json(scene.lights[edit.index].name) + " }");
        text = with_json(text, "/camera", camera_text(scene.cameras[edit.index]));
        return entry = "/camera";
    }

    void write(const Edit& edit) {
        const Property& property = find_property(scene, edit.part, edit.index, edit.property);
        const std::string pointer = entry_of(edit) + "/" + edit.property;
        const auto span = find_json(text, pointer);
        if (!span)
            text = with_json(text, pointer, value_text(property, edit.value));
        else if (text[span->begin] == '{')
            write_key(text, pointer, property, edit, scene.frame_rate);
        else
            write_value(text, pointer, property, edit.value);
    }
};

// JSON pointers to the members that name files, wherever they are in a scene, with their values.
std::vector<std::pair<std::string, std::string>> files_in(const Json& json, const std::string& pointer) {
    constexpr std::string_view members[] = {"$schema", "gltf", "image", "file", "recipe"};
    std::vector<std::pair<std::string, std::string>> files;
    const auto add = [&](const Json& child, const std::string& place) {
        for (auto& file : files_in(child, place)) files.push_back(std::move(file));
    };
    for (const auto& [key, value] : json.members) {
        const std::string place = json_pointer(pointer, key);
        if (value.kind == Json::Kind::string && std::ranges::count(members, key))
            files.emplace_back(place, value.string);
        add(value, place);
    }
    for (size_t i = 0; i < json.items.size(); ++i) add(json.items[i], json_pointer(pointer, i));
    return files;
}

bool is_relative_file(const std::string& path) {
    return !path.empty() && std::filesystem::path(path).is_relative() && path.find("://") == path.npos;
}
}

std::string edited_text(std::string text, const Scene& scene, std::span<const Edit> edits) {
    Writer writer(text, scene);
    for (const Edit& edit : edits) writer.write(edit);
    check_schema(parse_json(text, scene.file.string()), scene_schema, scene.file.string());
    return text;
}

std::string new_scene_text(Scene& scene) {
    std::string text = "{\n  \"tyndall\": 1,\n  \"gltf\": " + quote_json(scene.file.filename().string());
    for (CameraSource& camera : scene.cameras) {
        if (camera.node >= 0) continue;
        text += ",\n  \"camera\": " + camera_text(camera);
        camera.entry = "/camera";
    }
    const auto add = [&](const char* list, const std::vector<std::string>& entries) {
        if (entries.empty()) return;
        text += ",\n  \"" + std::string(list) + "\": [";
        for (const std::string& entry : entries) text += (&entry == entries.data() ? "\n    " : ",\n    ") + entry;
        text += "\n  ]";
    };
    std::vector<std::string> lights, media;
    for (LightSource& light : scene.lights) {
        if (light.node >= 0) continue;
        light.entry = "/lights/" + std::to_string(lights.size());
        lights.push_back(sun_text(light));
    }
    add("lights", lights);
    if (scene.ambient.at(0) != vec3(0)) text += ",\n  \"ambient\": " + list_text(scene.ambient.at(0));
    for (MediumSource& fog : scene.media) {
        fog.entry = "/media/" + std::to_string(media.size());
        media.push_back("{ \"name\": " + quote_json(fog.name) +
                        ", \"type\": \"height\", \"extinction\": " + json_number(fog.extinction.at(0)) +
                        ", \"g\": " + json_number(fog.g.at(0)) + ", \"base\": " + json_number(fog.height_base.at(0)) +
                        ", \"falloff\": " + json_number(fog.height_falloff.at(0)) + ", \"bounds\": { \"low\": " +
                        list_text(fog.bounds.low) + ", \"high\": " + list_text(fog.bounds.high) + " } }");
    }
    add("media", media);
    return text + "\n}\n";
}

std::string rebase_paths(std::string text, const std::filesystem::path& from, const std::filesystem::path& to) {
    std::error_code error; // folders that are missing or unreadable count as different
    if (std::filesystem::equivalent(from, to, error)) return text;
    for (const auto& [pointer, path] : files_in(parse_json(text, "scene"), "")) {
        if (!is_relative_file(path) || (pointer == "/$schema" && !std::filesystem::exists(from / path))) continue;
        const std::filesystem::path moved =
            std::filesystem::relative(std::filesystem::absolute(from / path), std::filesystem::absolute(to));
        text = with_json(text, pointer, quote_json(moved.string()));
    }
    return text;
}
}
