// glTF files made on the spot.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
std::string base64(std::string_view bytes);

std::string word_bytes(uint32_t value);

std::string chunk(std::string_view type, std::string bytes, char padding);

std::string glb_of(const std::string& json, const std::string& binary);

// Puts a glTF together: numbers go into one buffer, the rest is JSON text by member.
struct GltfBuilder {
    std::map<std::string, std::string> members;
    std::vector<std::string> views, accessors;
    std::string binary;

    // Add to the buffer, and return the index of the view or the accessor.
    int view(std::string_view bytes, const std::string& more = "");
    template<class T>
    int numbers(const std::vector<T>& values, int type, const char* shape, const std::string& more = "") {
        return accessor({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)}, values.size(), type,
                        shape, more);
    }
    int floats(const std::vector<float>& values, const char* shape);
    int indices(const std::vector<uint16_t>& values);

    std::string json(bool embedded = true) const;

private:
    int accessor(std::string_view bytes, size_t numbers, int type, std::string_view shape, const std::string& more);
};

// One triangle in a mesh on node 0: accessor 0 positions, 1 indices.
GltfBuilder triangle_gltf();
}
