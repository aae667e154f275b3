// The bytes behind the URIs of a glTF. Paths in a document are untrusted and may not leave its directory.
#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"
#include "scene/file/scene_file.h"
#include "scene/gltf/document.h"

#include <array>

namespace tyndall {
namespace {
namespace fs = std::filesystem;
constexpr uint64_t max_buffer_bytes = uint64_t{8} << 30;

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string percent_decoded(std::string_view text) {
    std::string result;
    for (size_t i = 0; i < text.size(); ++i) {
        const bool escape =
            text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0;
        result += escape ? static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2])) : text[i];
        if (escape) i += 2;
    }
    return result;
}

bool has_scheme(std::string_view uri) {
    const size_t colon = uri.find(':');
    return colon != uri.npos && colon < uri.find_first_of("/?#");
}

// Why a decoded path may not be opened; empty when it may.
std::string path_problem(std::string_view path) {
    if (path.empty()) return "names no file";
    for (const unsigned char c : path)
        if (c < 0x20 || c == 0x7f) return "holds a control character";
    if (path.find('\\') != path.npos) return "holds a backslash; glTF separates folders with /";
    if (path.front() == '/') return "is an absolute path; only files beside the glTF are opened";
    if (has_scheme(path)) return "names a protocol; only files beside the glTF are opened";
    for (const fs::path& part : fs::path(path))
        if (part == "..") return "leads out of the folder of the glTF";
    return {};
}

// The file a URI names, symbolic links resolved; guaranteed to be inside the document's directory.
fs::path resolved(const GltfDocument& document, const std::string& uri, const std::string& pointer) {
    const std::string decoded = percent_decoded(uri);
    if (const std::string problem = path_problem(decoded); !problem.empty())
        refuse(document.location(pointer), "\"" + printable(uri, 100) + "\" " + problem);

    // Some exporters do not escape percent signs in names.
    std::error_code error;
    fs::path path = document.directory / decoded;
    if (!fs::exists(path, error) && path_problem(uri).empty() && fs::exists(document.directory / uri, error))
        path = document.directory / uri;
    const fs::path inside = fs::canonical(document.directory, error);
    const fs::path target = error ? fs::path() : fs::canonical(path, error);
    if (error) fail(ExitCode::unreadable, document.location(pointer), "\"" + printable(uri, 100) + "\": no such file");
    const auto [end, rest] = std::mismatch(inside.begin(), inside.end(), target.begin(), target.end());
    if (end != inside.end())
        refuse(document.location(pointer),
               "\"" + printable(uri, 100) + "\" is a link that leads out of the folder of the glTF");
    return target;
}

std::string base64_decoded(std::string_view text, const std::string& location) {
    static constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<int8_t, 256> values;
    values.fill(-1);
    for (size_t i = 0; i < alphabet.size(); ++i)
        values[static_cast<unsigned char>(alphabet[i])] = static_cast<int8_t>(i);
    values['-'] = 62, values['_'] = 63;

    while (text.ends_with('=')) text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    uint32_t bits = 0;
    int count = 0;
    for (const unsigned char c : text) {
        if (values[c] < 0) refuse(location, "the data URI holds characters that are not base64");
        bits = bits << 6 | static_cast<uint32_t>(values[c]), count += 6;
        if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 0xff);
    }
    return bytes;
}

std::string data_uri_bytes(std::string_view uri, const std::string& location) {
    const size_t comma = uri.find(',');
    if (comma == uri.npos) refuse(location, "the data URI has no comma before its data");
    const std::string_view data = uri.substr(comma + 1);
    if (!uri.substr(0, comma).ends_with(";base64")) return percent_decoded(data);
    return base64_decoded(data.find('%') == data.npos ? std::string(data) : percent_decoded(data), location);
}

bool is_data_uri(std::string_view uri) { return lower_case(std::string(uri.substr(0, 5))) == "data:"; }

// A buffer's data, exactly byteLength bytes; if there is none, `lacking` says why.
std::string buffer_bytes(GltfDocument& document, const Json& buffer, size_t index, const GltfContainer& container,
                         std::string& lacking) {
    const std::string pointer = gltf_pointer("buffers", index);
    const uint64_t length = static_cast<uint64_t>(buffer.number_or("byteLength", 0));
    const Json* uri = buffer.find("uri");
    std::string bytes;
    if (uri) {
        // A file far larger than its buffer is refused without reading it.
        bytes = gltf_uri_bytes(document, uri->string, pointer + "/uri", 2 * length + (uint64_t{64} << 20));
    } else if (index == 0 && container.has_binary) {
        bytes = container.binary;
    } else {
        lacking = "the buffer has no uri and the file no binary chunk";
        return {};
    }
    if (bytes.size() < length)
        refuse(document.location(pointer + "/byteLength"),
               "is " + std::to_string(length) + ", but the data has " + std::to_string(bytes.size()) + " bytes");
    bytes.resize(length);
    return bytes;
}
}

std::string gltf_uri_bytes(GltfDocument& document, const std::string& uri, const std::string& pointer, uint64_t most) {
    if (is_data_uri(uri)) return data_uri_bytes(uri, document.location(pointer));
    const fs::path path = resolved(document, uri, pointer);
    std::string bytes;
    const Field field{nullptr, document.file, pointer};
    with_location(field, [&] { bytes = read_file(path, most); });
    add_input(*document.scene, path, bytes);
    return bytes;
}

void load_gltf_buffers(GltfDocument& document, const Json& json, const GltfContainer& container) {
    const Json* buffers = json.find("buffers");
    if (!buffers) return;
    uint64_t total = 0;
    for (size_t i = 0; i < buffers->items.size(); ++i) {
        total += static_cast<uint64_t>(buffers->items[i].number_or("byteLength", 0));
        if (total > max_buffer_bytes)
            refuse(document.location(gltf_pointer("buffers", i, "byteLength")), "all buffers together are over 8 GiB");
        document.lacking.emplace_back();
        document.buffers.push_back(buffer_bytes(document, buffers->items[i], i, container, document.lacking.back()));
    }
}

void list_gltf_images(GltfDocument& document, const Json& json) {
    const Json* images = json.find("images");
    if (!images) return;
    for (size_t i = 0; i < images->items.size(); ++i) {
        const Json& image = images->items[i];
        if (image.has("uri") == image.has("bufferView"))
            refuse(document.location(gltf_pointer("images", i)), "needs exactly one of uri and bufferView");
        document.images.push_back({image.string_or("uri", ""), static_cast<int>(image.number_or("bufferView", -1))});
    }
}
}
