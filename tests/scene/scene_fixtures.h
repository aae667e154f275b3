// Files for tests: a folder of one's own, scene files and glTF made on the spot.
#pragma once
#include "base/error.h"
#include "base/scratch.h"
#include "scene/scene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
struct Folder : Scratch {
    std::filesystem::path write(std::string_view name, std::string_view bytes) const {
        std::filesystem::create_directories((*this / std::string(name)).parent_path());
        return put(std::string(name), std::string(bytes));
    }
};

// What loading a file answers: the scene, or one line of refusal.
struct LoadAnswer {
    Scene scene;
    bool loaded = false;
    ExitCode code = ExitCode::ok;
    std::string message;
};

inline LoadAnswer load(const std::filesystem::path& file, const LoadOptions& options = {}) {
    LoadAnswer answer;
    try {
        answer.scene = load_scene(file, options);
        answer.loaded = true;
    } catch (const Error& error) {
        answer.code = error.code;
        answer.message = error.what();
    }
    return answer;
}

// A refusal is one short printable line.
inline void expect_one_line(const std::string& message) {
    EXPECT_LE(message.size(), 500u) << message;
    EXPECT_FALSE(message.empty());
    for (const unsigned char c : message) EXPECT_TRUE(c >= 0x20 && c != 0x7f) << message;
}

inline void expect_refusal(const LoadAnswer& answer, std::string_view part, ExitCode code = ExitCode::refused) {
    EXPECT_FALSE(answer.loaded) << "loaded, but should name " << part;
    EXPECT_EQ(static_cast<int>(answer.code), static_cast<int>(code)) << answer.message;
    EXPECT_NE(answer.message.find(part), std::string::npos) << answer.message;
    expect_one_line(answer.message);
}

inline bool has_warning(const Scene& scene, std::string_view part) {
    for (const std::string& warning : scene.warnings)
        if (warning.find(part) != std::string::npos) return true;
    return false;
}

inline std::string base64(std::string_view bytes) {
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

inline std::string word_bytes(uint32_t value) {
    return {static_cast<char>(value), static_cast<char>(value >> 8), static_cast<char>(value >> 16),
            static_cast<char>(value >> 24)};
}

inline std::string chunk(std::string_view type, std::string bytes, char padding) {
    while (bytes.size() % 4) bytes += padding;
    return word_bytes(static_cast<uint32_t>(bytes.size())) + std::string(type) + bytes;
}

inline std::string glb_of(const std::string& json, const std::string& binary) {
    std::string body = chunk("JSON", json, ' ');
    if (!binary.empty()) body += chunk(std::string_view("BIN\0", 4), binary, '\0');
    return "glTF" + word_bytes(2) + word_bytes(static_cast<uint32_t>(12 + body.size())) + body;
}

// Puts a glTF together: numbers go into one buffer, the rest is JSON text by member.
class GltfBuilder {
public:
    std::map<std::string, std::string> members;
    std::vector<std::string> views, accessors;
    std::string binary;

    int view(std::string_view bytes, const std::string& more = "") {
        while (binary.size() % 4) binary += '\0';
        views.push_back(R"({"buffer":0,"byteOffset":)" + std::to_string(binary.size()) + R"(,"byteLength":)" +
                        std::to_string(bytes.size()) + more + "}");
        binary += bytes;
        return static_cast<int>(views.size()) - 1;
    }
    template<class T>
    int numbers(const std::vector<T>& values, int type, const char* shape, const std::string& more = "") {
        const std::string_view name(shape);
        const size_t parts = name == "SCALAR" ? 1 : name == "MAT4" ? 16 : static_cast<size_t>(name.back() - '0');
        const int place = view({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
        accessors.push_back(R"({"bufferView":)" + std::to_string(place) + R"(,"componentType":)" +
                            std::to_string(type) + R"(,"count":)" + std::to_string(values.size() / parts) +
                            R"(,"type":")" + shape + "\"" + more + "}");
        return static_cast<int>(accessors.size()) - 1;
    }
    int floats(const std::vector<float>& values, const char* shape) { return numbers(values, 5126, shape); }
    int indices(const std::vector<uint16_t>& values) { return numbers(values, 5123, "SCALAR"); }

    std::string json(bool embedded = true) const {
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
};

// One triangle in a mesh on node 0: accessor 0 positions, 1 indices.
inline GltfBuilder triangle_gltf() {
    GltfBuilder gltf;
    gltf.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    gltf.indices({0, 1, 2});
    gltf.members["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])";
    gltf.members["nodes"] = R"([{"name":"thing","mesh":0}])";
    gltf.members["scenes"] = R"([{"nodes":[0]}])";
    return gltf;
}
}
