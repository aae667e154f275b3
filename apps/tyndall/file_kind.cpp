#include "file_kind.h"

#include "base/error.h"
#include "base/io/file.h"
#include "volume/vdb/vdb.h"

#include <fstream>

namespace tyndall {
namespace {
std::string first_bytes(const std::filesystem::path& file) {
    std::string bytes(8, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<size_t>(stream.gcount()));
    return bytes;
}

// By the schema it names, else by a key that only one of them has.
FileKind json_kind(const std::filesystem::path& file) {
    const Json document = parse_json(read_file(file), file.string());
    const std::string schema = document.string_or("$schema", "");
    if (schema.ends_with("recipe.schema.json")) return FileKind::recipe;
    if (schema.ends_with("scene.schema.json")) return FileKind::scene;
    if (schema.find("json-schema.org") != schema.npos) return FileKind::schema;
    if (document.has("asset")) return FileKind::gltf;
    for (const char* key : {"bounds", "voxel_size", "noise", "density"})
        if (document.has(key)) return FileKind::recipe;
    for (const char* key : {"tyndall", "gltf", "camera", "lights", "media", "background"})
        if (document.has(key)) return FileKind::scene;
    refuse(file.string(), "neither a scene nor a fog recipe: a scene has \"tyndall\": 1, a recipe has \"bounds\"");
}
}

FileKind file_kind(const std::filesystem::path& file) {
    check_readable(file);
    const std::string extension = file.extension().string();
    if (is_volume_name(file)) return FileKind::vdb;
    if (extension == ".gltf" || extension == ".glb") return FileKind::gltf;
    if (extension == ".exr") return FileKind::exr;
    if (extension == ".ies" || extension == ".IES") return FileKind::ies;
    if (extension == ".json") return json_kind(file);

    const std::string bytes = first_bytes(file);
    if (bytes.starts_with(" BDV") || bytes.starts_with("NanoVDB")) return FileKind::vdb;
    if (bytes.starts_with("glTF")) return FileKind::gltf;
    if (bytes.starts_with("\x76\x2f\x31\x01")) return FileKind::exr;
    if (bytes.starts_with("IESNA") || bytes.starts_with("IES:LM-6")) return FileKind::ies;
    refuse(file.string(), "unknown kind of file; expected one of (.vdb .nvdb .gltf .glb .json .exr .ies)");
}
}
