// Checks the indices and offsets of a glTF: every read stays inside its buffer, every traversal of the nodes ends.
#include "base/error.h"
#include "scene/gltf/document.h"

#include <cmath>

namespace tyndall {
namespace {
constexpr uint64_t max_elements_of_zeros = uint64_t{1} << 24; // of an accessor without data
constexpr int max_levels = 256;

void check_buffer_views(const GltfDocument& document) {
    for (size_t i = 0; i < document.model.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = document.model.bufferViews[i];
        const uint64_t size = document.buffers[view.buffer].size();
        if (!document.lacking[view.buffer].empty()) continue; // refused where it is read
        if (view.byteOffset > size || view.byteLength > size - view.byteOffset)
            refuse(document.location(gltf_pointer("bufferViews", i)),
                   "needs bytes " + std::to_string(view.byteOffset) + " to " +
                       std::to_string(view.byteOffset + view.byteLength) + " of a buffer that has only " +
                       std::to_string(size));
    }
}

// Bytes from the start of an element to its last component: the last column of a matrix needs no padding.
uint64_t extent(const tinygltf::Accessor& accessor, uint64_t size) {
    const uint64_t component = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
    const uint64_t columns = accessor.type == TINYGLTF_TYPE_MAT2 ? 2 : accessor.type == TINYGLTF_TYPE_MAT3 ? 3 : 1;
    return columns == 1 ? size : size - size / columns + columns * component;
}

// Checks that `count` elements of `size` bytes, `stride` apart, starting at `offset` fit the buffer view.
void check_span(const GltfDocument& document, int view_index, uint64_t offset, uint64_t count, uint64_t size,
                uint64_t stride, const std::string& pointer) {
    const uint64_t length = document.model.bufferViews[view_index].byteLength;
    if (count == 0) return;
    if (offset <= length && size <= length - offset && count - 1 <= (length - offset - size) / stride) return;
    refuse(document.location(pointer), std::to_string(count) + " elements of " + std::to_string(size) + " bytes, " +
                                           std::to_string(stride) + " apart, from byte " + std::to_string(offset) +
                                           " do not fit in buffer view " + std::to_string(view_index) + ", which has " +
                                           std::to_string(length) + " bytes");
}

void check_accessors(const GltfDocument& document) {
    for (size_t i = 0; i < document.model.accessors.size(); ++i) {
        const tinygltf::Accessor& accessor = document.model.accessors[i];
        const std::string pointer = gltf_pointer("accessors", i);
        const uint64_t size = gltf_element_bytes(accessor);
        if (accessor.bufferView >= 0) {
            const uint64_t stride = document.model.bufferViews[accessor.bufferView].byteStride;
            if (stride && stride < size)
                refuse(document.location(gltf_pointer("bufferViews", accessor.bufferView, "byteStride")),
                       "is " + std::to_string(stride) + ", less than the " + std::to_string(size) +
                           " bytes of an element of accessor " + std::to_string(i));
            check_span(document, accessor.bufferView, accessor.byteOffset, accessor.count, extent(accessor, size),
                       stride ? stride : size, pointer);
        } else if (accessor.count > max_elements_of_zeros) {
            refuse(document.location(pointer + "/count"),
                   "is " + std::to_string(accessor.count) + ": too many for an accessor without a buffer view");
        }
        if (!accessor.sparse.isSparse) continue;
        const auto& sparse = accessor.sparse;
        if (static_cast<uint64_t>(sparse.count) > accessor.count)
            refuse(document.location(pointer + "/sparse/count"), "is greater than the accessor's count");
        const uint64_t index_size =
            tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(sparse.indices.componentType));
        check_span(document, sparse.indices.bufferView, sparse.indices.byteOffset, sparse.count, index_size, index_size,
                   pointer + "/sparse/indices");
        check_span(document, sparse.values.bufferView, sparse.values.byteOffset, sparse.count, extent(accessor, size),
                   size, pointer + "/sparse/values");
    }
}

// Nodes form a forest: at most one parent each, no cycles, at most 256 levels.
void check_nodes(const GltfDocument& document) {
    const std::vector<tinygltf::Node>& nodes = document.model.nodes;
    std::vector<int> parent(nodes.size(), -1);
    for (size_t i = 0; i < nodes.size(); ++i)
        for (size_t c = 0; c < nodes[i].children.size(); ++c) {
            int& known = parent[nodes[i].children[c]];
            if (known >= 0)
                refuse(document.location(gltf_pointer("nodes", i, "children/") + std::to_string(c)),
                       "node " + std::to_string(nodes[i].children[c]) + " is already a child of node " +
                           std::to_string(known));
            known = static_cast<int>(i);
        }

    // A chain of parents longer than the limit is either too deep or a cycle.
    std::vector<int> level(nodes.size(), 0);
    for (size_t i = 0; i < nodes.size(); ++i) {
        int steps = 0, at = static_cast<int>(i);
        while (at >= 0 && !level[at] && ++steps <= max_levels) at = parent[at];
        const int above = at >= 0 && level[at] ? level[at] : 0;
        if (steps + above > max_levels)
            refuse(document.location(gltf_pointer("nodes", i)),
                   "its parents form a cycle, or go more than 256 levels up");
        int down = steps + above;
        for (int walk = static_cast<int>(i); walk >= 0 && !level[walk]; walk = parent[walk]) level[walk] = down--;
    }

    for (size_t s = 0; s < document.model.scenes.size(); ++s) {
        const std::vector<int>& roots = document.model.scenes[s].nodes;
        for (size_t i = 0; i < roots.size(); ++i)
            if (parent[roots[i]] >= 0)
                refuse(document.location(gltf_pointer("scenes", s, "nodes/") + std::to_string(i)),
                       "node " + std::to_string(roots[i]) + " is not a root: it is a child of node " +
                           std::to_string(parent[roots[i]]));
    }
}

void check_animations(const GltfDocument& document) {
    for (size_t a = 0; a < document.model.animations.size(); ++a) {
        const tinygltf::Animation& animation = document.model.animations[a];
        for (const tinygltf::AnimationChannel& channel : animation.channels)
            if (channel.sampler < 0 || static_cast<size_t>(channel.sampler) >= animation.samplers.size())
                refuse(document.location(gltf_pointer("animations", a, "channels")),
                       "sampler " + std::to_string(channel.sampler) + " does not exist; the number of samplers is " +
                           std::to_string(animation.samplers.size()));
    }
}

void check_cameras(const GltfDocument& document) {
    for (size_t i = 0; i < document.model.cameras.size(); ++i) {
        const tinygltf::OrthographicCamera& ortho = document.model.cameras[i].orthographic;
        const tinygltf::PerspectiveCamera& perspective = document.model.cameras[i].perspective;
        const bool is_ortho = document.model.cameras[i].type == "orthographic";
        if (is_ortho && ortho.ymag == 0)
            refuse(document.location(gltf_pointer("cameras", i, "orthographic/ymag")), "must not be 0");
        if (is_ortho ? ortho.zfar <= ortho.znear : perspective.zfar > 0 && perspective.zfar <= perspective.znear)
            refuse(document.location(gltf_pointer("cameras", i)), "zfar must be greater than znear");
    }
}
}

uint64_t gltf_element_bytes(const tinygltf::Accessor& accessor) {
    const uint64_t component = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
    // Columns of matrices start at multiples of four bytes.
    if (accessor.type == TINYGLTF_TYPE_MAT2) return 2 * ((2 * component + 3) / 4 * 4);
    if (accessor.type == TINYGLTF_TYPE_MAT3) return 3 * ((3 * component + 3) / 4 * 4);
    return component * tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
}

void check_gltf_ranges(const GltfDocument& document) {
    check_buffer_views(document);
    check_accessors(document);
    check_nodes(document);
    check_animations(document);
    check_cameras(document);
}
}
