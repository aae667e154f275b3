// Parses the checked JSON with tinygltf.
#include "base/error.h"
#include "base/json/json_pointer.h"
#include "scene/gltf/document.h"

#include <cmath>

namespace tyndall {
namespace {
// tinygltf does not accept 1e5 as an integer, so integers are written with all their digits.
void append_number(std::string& text, double number) {
    if (number == std::floor(number) && std::abs(number) < 9e15) {
        text += std::to_string(static_cast<int64_t>(number));
        return;
    }
    text += format_json(number);
}

// Members that nothing reads, so that they may hold anything.
bool is_unused(std::string_view name) {
    return name == "extras" || name == "min" || name == "max" || name == "metallicFactor" ||
           name == "roughnessFactor" || name == "metallicRoughnessTexture";
}

void append(std::string& text, const Json& value, bool root) {
    if (value.kind == Json::Kind::number) return append_number(text, value.number);
    if (value.kind == Json::Kind::array) {
        text += '[';
        for (const Json& item : value.items) {
            if (&item != value.items.data()) text += ',';
            append(text, item, false);
        }
        text += ']';
    } else if (value.kind == Json::Kind::object) {
        text += '{';
        bool first = true;
        for (const auto& [name, member] : value.members) {
            if (is_unused(name) || (root && (name == "buffers" || name == "images"))) continue;
            if (!first) text += ',';
            first = false;
            text += quote_json(name) + ":";
            append(text, member, false);
        }
        text += '}';
    } else {
        text += format_json(value);
    }
}

// The text names no files; if tinygltf asks for one all the same, it does not exist.
tinygltf::FsCallbacks no_files() {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string&, void*) { return false; };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&, void*) {
        return false;
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    return callbacks;
}

bool no_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
    return false;
}
}

void parse_gltf(GltfDocument& document, const Json& json) {
    std::string text;
    append(text, json, true);
    if (text.size() > std::numeric_limits<unsigned>::max()) refuse(document.file, "the JSON is over 4 GiB");

    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks(no_files());
    parser.SetImageLoader(no_image, nullptr);
    std::string errors, warnings;
    if (!parser.LoadASCIIFromString(&document.model, &errors, &warnings, text.data(),
                                    static_cast<unsigned>(text.size()), ""))
        refuse(document.file, errors.substr(0, errors.find('\n')));
}
}
