#include "support/gltf_builder.h"

namespace tyndall {
std::string base64(std::string_view bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string word_bytes(uint32_t value) {
    return {static_cast<char>(value), static_cast<char>(value >> 8), static_cast<char>(value >> 16),
            static_cast<char>(value >> 24)};
}

std::string chunk(std::string_view type, std::string bytes, char padding) {
    while (bytes.size() % 4) bytes += padding;
    return word_bytes(static_cast<uint32_t>(bytes.size())) + std::string(type) + bytes;
}

std::string glb_of(const std::string& json, const std::string& binary) {
    std::string body = chunk("JSON", json, ' ');
    if (!binary.empty()) body += chunk(std::string_view("BIN\0", 4), binary, '\0');
    return "glTF" + word_bytes(2) + word_bytes(static_cast<uint32_t>(12 + body.size())) + body;
}

int GltfBuilder::view(std::string_view bytes, const std::string& more) {
    while (binary.size() % 4) binary += '\0';
    views.push_back(R"({"buffer":0,"byteOffset":)" + std::to_string(binary.size()) + R"(,"byteLength":)" +
                    std::to_string(bytes.size()) + more + "}");
    binary += bytes;
    return static_cast<int>(views.size()) - 1;
}

int GltfBuilder::accessor(std::string_view bytes, size_t numbers, int type, std::string_view shape,
                          const std::string& more) {
    const size_t parts = shape == "SCALAR" ? 1 : shape == "MAT4" ? 16 : static_cast<size_t>(shape.back() - '0');
    const int place = view(bytes);
    accessors.push_back(R"({"bufferView":)" + std::to_string(place) + R"(,"componentType":)" + std::to_string(type) +
                        R"(,"count":)" + std::to_string(numbers / parts) + R"(,"type":")" + std::string(shape) + "\"" +
                        more + "}");
    return static_cast<int>(accessors.size()) - 1;
}

int GltfBuilder::floats(const std::vector<float>& values, const char* shape) { return numbers(values, 5126, shape); }
int GltfBuilder::indices(const std::vector<uint16_t>& values) { return numbers(values, 5123, "SCALAR"); }

std::string GltfBuilder::json(bool embedded) const {
    std::string text = R"({"asset":{"version":"2.0"})";
    const auto list = [&](const char* name, const std::vector<std::string>& items) {
        if (items.empty()) return;
        text += ",\"" + std::string(name) + "\":[";
        for (const std::string& item : items) text += (&item == items.data() ? "" : ",") + item;
        text += "]";
    };
    if (!binary.empty() && !members.contains("buffers"))
        text += R"(,"buffers":[{"byteLength":)" + std::to_string(binary.size()) +
                (embedded ? R"(,"uri":"data:application/octet-stream;base64,)" + base64(binary) + "\"" : "") + "}]";
    if (!members.contains("bufferViews")) list("bufferViews", views);
    if (!members.contains("accessors")) list("accessors", accessors);
    for (const auto& [name, value] : members) text += ",\"" + name + "\":" + value;
    return text + "}";
}

GltfBuilder triangle_gltf() {
    GltfBuilder gltf;
    gltf.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    gltf.indices({0, 1, 2});
    gltf.members["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])";
    gltf.members["nodes"] = R"([{"name":"thing","mesh":0}])";
    gltf.members["scenes"] = R"([{"nodes":[0]}])";
    return gltf;
}
}
