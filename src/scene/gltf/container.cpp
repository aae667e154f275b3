// The container of a glTF: plain JSON, or a .glb with a header and chunks (glTF 2.0, section 4.4).
#include "base/error.h"
#include "base/io/file.h"
#include "scene/gltf/document.h"

namespace tyndall {
namespace {
constexpr uint64_t max_bytes = uint64_t{4} << 30;
constexpr uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

uint32_t word(std::string_view bytes, size_t offset) {
    const auto byte = [&](size_t i) { return static_cast<uint32_t>(static_cast<unsigned char>(bytes[offset + i])); };
    return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}

void split_chunks(GltfContainer& container, const std::string& file) {
    std::string_view rest = container.bytes;
    if (rest.size() < 20) refuse(file, "the GLB is truncated: its header and first chunk need 20 bytes");
    if (const uint32_t version = word(rest, 4); version != 2)
        refuse(file, "GLB version " + std::to_string(version) + "; only glTF 2.0 can be read");
    const uint64_t length = word(rest, 8);
    if (length > rest.size())
        refuse(file, "the GLB is truncated: its header states " + std::to_string(length) + " bytes, the file has " +
                         std::to_string(rest.size()));
    if (length < 20) refuse(file, "the GLB header states " + std::to_string(length) + " bytes: too few for a chunk");
    if (length < rest.size())
        container.warnings.push_back(std::to_string(rest.size() - length) +
                                     " bytes after the end of the GLB are ignored");

    rest = rest.substr(12, length - 12);
    for (size_t chunk = 0; !rest.empty(); ++chunk) {
        const std::string name = "GLB chunk " + std::to_string(chunk);
        if (rest.size() < 8) refuse(file, name + " is truncated: its header needs 8 bytes");
        const uint64_t size = word(rest, 0);
        const uint32_t type = word(rest, 4);
        if (size > rest.size() - 8)
            refuse(file, name + " states " + std::to_string(size) + " bytes, but " + std::to_string(rest.size() - 8) +
                             " are left");
        if (size % 4) refuse(file, name + " has " + std::to_string(size) + " bytes, which is not a multiple of 4");
        if ((type == json_chunk) != (chunk == 0))
            refuse(file, chunk ? name + " is a second JSON chunk" : "the first GLB chunk is not JSON");
        if (chunk == 0) {
            container.json = rest.substr(8, size);
        } else if (type == binary_chunk && !container.has_binary) {
            if (chunk != 1) refuse(file, name + " holds the binary data, which must be the second chunk");
            container.binary = rest.substr(8, size), container.has_binary = true;
        } else if (type == binary_chunk) {
            refuse(file, name + " is a second binary chunk");
        }
        rest.remove_prefix(8 + size);
    }
}
}

GltfContainer read_gltf_container(const std::filesystem::path& path) {
    const std::string file = path.string();
    GltfContainer container;
    container.bytes = read_file(path, max_bytes);
    const std::string_view bytes = container.bytes;
    if (bytes.starts_with("glTF")) {
        split_chunks(container, file);
        return container;
    }
    if (bytes.starts_with("version https://git-lfs"))
        refuse(file, "is a Git LFS pointer, not the file itself; fetch it with \"git lfs pull\"");
    const size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == bytes.npos) refuse(file, "is empty");
    if (bytes[first] != '{' && !bytes.starts_with("\xef\xbb\xbf")) refuse(file, "is neither glTF JSON nor a GLB");
    container.json = bytes;
    return container;
}
}
