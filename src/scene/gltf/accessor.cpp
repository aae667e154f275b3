// Reads accessor elements as plain numbers. Ranges have already been checked.
#include "base/error.h"
#include "scene/gltf/document.h"

#include <cstring>

namespace tyndall {
namespace {
const char* const type_names[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};

// The data of a buffer view; throws if its buffer has none.
const char* view_data(const GltfDocument& document, int view_index, const std::string& pointer) {
    const tinygltf::BufferView& view = document.model.bufferViews[view_index];
    if (const std::string& why = document.lacking[view.buffer]; !why.empty())
        refuse(document.location(pointer),
               "needs buffer " + std::to_string(view.buffer) + ", which has no data: " + why);
    return document.buffers[view.buffer].data() + view.byteOffset;
}

// Calls put(element, component, value) with values of one component type.
template<class T, class Put>
void each(const char* data, size_t count, size_t stride, size_t components, const Put& put) {
    for (size_t i = 0; i < count; ++i)
        for (size_t c = 0; c < components; ++c) {
            T value;
            std::memcpy(&value, data + i * stride + c * sizeof(T), sizeof(T));
            put(i, c, value);
        }
}

template<class Put>
void each(int component_type, const char* data, size_t count, size_t stride, size_t components, const Put& put) {
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return each<int8_t>(data, count, stride, components, put);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return each<uint8_t>(data, count, stride, components, put);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return each<int16_t>(data, count, stride, components, put);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return each<uint16_t>(data, count, stride, components, put);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return each<uint32_t>(data, count, stride, components, put);
    default:
        return each<float>(data, count, stride, components, put);
    }
}

// Visits every element, then the sparse elements that replace some of them.
template<class Put>
void each_element(const GltfDocument& document, const tinygltf::Accessor& accessor, size_t components,
                  const std::string& pointer, const Put& put) {
    const size_t size = gltf_element_bytes(accessor);
    if (accessor.bufferView >= 0) {
        const size_t stride = document.model.bufferViews[accessor.bufferView].byteStride;
        each(accessor.componentType, view_data(document, accessor.bufferView, pointer) + accessor.byteOffset,
             accessor.count, stride ? stride : size, components, put);
    }
    if (!accessor.sparse.isSparse) return;

    const auto& sparse = accessor.sparse;
    const char* indices = view_data(document, sparse.indices.bufferView, pointer) + sparse.indices.byteOffset;
    const char* values = view_data(document, sparse.values.bufferView, pointer) + sparse.values.byteOffset;
    const size_t index_size = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(sparse.indices.componentType));
    std::vector<size_t> places(sparse.count);
    each(sparse.indices.componentType, indices, sparse.count, index_size, 1,
         [&](size_t i, size_t, auto value) { places[i] = static_cast<size_t>(value); });
    for (const size_t location : places)
        if (location >= accessor.count)
            refuse(document.location(pointer), "the sparse accessor replaces element " + std::to_string(location) +
                                                   ", but has only " + std::to_string(accessor.count));
    each(accessor.componentType, values, sparse.count, size, components,
         [&](size_t i, size_t c, auto value) { put(places[i], c, value); });
}

// Normalized integers represent 0..1 or -1..1 (glTF 2.0, section 3.11).
float normalized(float value) { return value; }
float normalized(uint8_t value) { return value / 255.0f; }
float normalized(uint16_t value) { return value / 65535.0f; }
float normalized(uint32_t value) { return static_cast<float>(value / 4294967295.0); }
float normalized(int8_t value) { return std::max(value / 127.0f, -1.0f); }
float normalized(int16_t value) { return std::max(value / 32767.0f, -1.0f); }
}

std::vector<float> gltf_floats(GltfDocument& document, int index, int components, const std::string& pointer,
                               Scaling scaling) {
    const tinygltf::Accessor& accessor = document.model.accessors[index];
    const int has = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
    if (has != components)
        refuse(document.location(pointer), "accessor " + std::to_string(index) + " should be of type " +
                                               (components <= 4 ? type_names[components] : "MAT4"));
    const bool scale = accessor.normalized || scaling == Scaling::normalized;
    std::vector<float> values(accessor.count * components);
    each_element(document, accessor, components, pointer, [&](size_t i, size_t c, auto value) {
        values[i * components + c] = scale ? normalized(value) : static_cast<float>(value);
    });
    return values;
}

std::vector<uint32_t> gltf_integers(GltfDocument& document, int index, const std::string& pointer) {
    const tinygltf::Accessor& accessor = document.model.accessors[index];
    if (accessor.type != TINYGLTF_TYPE_SCALAR || (accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                                                  accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                                                  accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
        refuse(document.location(pointer),
               "accessor " + std::to_string(index) + " should hold unsigned integers (SCALAR)");
    std::vector<uint32_t> values(accessor.count);
    each_element(document, accessor, 1, pointer,
                 [&](size_t i, size_t, auto value) { values[i] = static_cast<uint32_t>(value); });
    return values;
}
}
