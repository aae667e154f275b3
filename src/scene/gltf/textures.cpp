// Textures and their images, which are reduced evenly where they would take too much memory.
#include "base/error.h"
#include "base/text.h"
#include "scene/gltf/document.h"
#include "scene/images/image_file.h"

#include <algorithm>

namespace tyndall {
namespace {
// The encoded bytes of an image. The caller tolerates a missing file, but not a forbidden path.
std::string image_bytes(GltfDocument& document, int index, const std::string& pointer) {
    const GltfImage& image = document.images[index];
    if (image.buffer_view < 0) return gltf_uri_bytes(document, image.uri, pointer + "/uri", uint64_t{1} << 30);
    const tinygltf::BufferView& view = document.model.bufferViews[image.buffer_view];
    if (const std::string& why = document.lacking[view.buffer]; !why.empty())
        fail(ExitCode::unreadable, document.location(pointer), why);
    return document.buffers[view.buffer].substr(view.byteOffset, view.byteLength);
}

std::string format_name(std::string_view bytes) {
    if (bytes.starts_with("RIFF") && bytes.substr(0, 16).find("WEBP") != bytes.npos) return "WebP";
    if (bytes.starts_with("\xABKTX 20")) return "KTX2";
    return "neither PNG nor JPEG";
}

Texels decoded_image(GltfDocument& document, int index) {
    const std::string pointer = gltf_pointer("images", index);
    std::string bytes;
    try {
        bytes = image_bytes(document, index, pointer);
    } catch (const Error& error) {
        if (error.code == ExitCode::refused) throw;
        const std::string text = error.what(), location = pointer + "/uri: ";
        const size_t at = text.find(location); // strips the place, which the warning repeats
        document.warn(pointer, "the material's color is used instead: " +
                                   (at == text.npos ? text : text.substr(at + location.size())));
        return {};
    }
    const ImageFormat format = image_format(bytes);
    if (format != ImageFormat::png && format != ImageFormat::jpeg) {
        document.warn(pointer, "the image is " + format_name(bytes) + "; the material's color is used instead");
        return {};
    }
    try {
        return decode_texture(bytes, "");
    } catch (const Error& error) {
        document.warn(pointer, std::string(error.what()) + "; the material's color is used instead");
        return {};
    }
}

int longer_side(const Texels& texels) { return std::max(texels.size().x, texels.size().y); }

// Halves images until all are within the limit of the side, and that limit until together they take no more memory than
// they may: all then lose detail alike, whichever comes first.
void fit_images(GltfDocument& document) {
    for (;; document.texture_side /= 2) {
        size_t bytes = 0;
        for (auto& [index, image] : document.decoded) {
            if (!image.texels) continue;
            while (longer_side(*image.texels) > document.texture_side) *image.texels = halved(*image.texels);
            bytes += image.texels->bytes();
        }
        if (bytes <= document.options.texture_bytes || document.texture_side == 1) return;
    }
}

// The texels of an image, decoded once; null if it cannot be used.
std::shared_ptr<const Texels> image_texels(GltfDocument& document, int index) {
    const auto [known, added] = document.decoded.try_emplace(index);
    GltfTexels& image = known->second;
    if (!added) return image.texels;
    Texels texels = decoded_image(document, index);
    if (texels.empty()) return nullptr;
    image.side = longer_side(texels);
    image.texels = std::make_shared<Texels>(std::move(texels));
    fit_images(document);
    return image.texels;
}

void set_sampler(const tinygltf::Model& model, int index, Texture& texture) {
    if (index < 0) return;
    const tinygltf::Sampler& sampler = model.samplers[index];
    texture.repeat_u = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    texture.repeat_v = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    texture.mirror_u = sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    texture.mirror_v = sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

std::string key_of(const GltfTextureUse& use, const tinygltf::Texture& texture) {
    const mat3& m = use.transform;
    return formatted("%d %d %a %a %a %a %a %a", texture.source, texture.sampler, m[0].x, m[0].y, m[1].x, m[1].y, m[2].x,
                     m[2].y);
}
}

int gltf_texture(GltfDocument& document, const GltfTextureUse& use) {
    if (use.texture < 0) return -1;
    const tinygltf::Texture& source = document.model.textures[use.texture];
    if (source.source < 0) {
        document.warn(gltf_pointer("textures", use.texture),
                      "has no PNG or JPEG; the material's color is used instead");
        return -1;
    }
    const auto [known, added] = document.textures.try_emplace(key_of(use, source), -1);
    if (!added) return known->second;

    Texture texture;
    texture.texels = image_texels(document, source.source);
    if (!texture.texels) return -1;
    texture.name = source.name;
    texture.uv_transform = use.transform;
    set_sampler(document.model, source.sampler, texture);
    known->second = static_cast<int>(document.scene->textures.size());
    document.scene->textures.push_back(std::move(texture));
    return known->second;
}

void note_reduced_textures(GltfDocument& document) {
    size_t images = 0, reduced = 0;
    for (const auto& [index, image] : document.decoded)
        images += image.texels != nullptr, reduced += image.texels && image.side > document.texture_side;
    if (reduced == 0) return;
    const bool together = document.texture_side < largest_texture_side;
    document.warn("/images", std::to_string(reduced) + " of " + count_text(images, "image") +
                                 " are reduced to at most " + std::to_string(document.texture_side) +
                                 " pixels on a side" + (together ? ", so that all fit in 1 GiB" : ""));
}
}
