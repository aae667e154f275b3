// Textures that share and outgrow memory, and materials of glass.
#include "scene/images.h"
#include "support/expect.h"
#include "support/gltf_builder.h"
#include "support/load_answer.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
// The triangle once with each material.
GltfBuilder with_materials(const std::vector<std::string>& materials) {
    GltfBuilder gltf = triangle_gltf();
    const int uv = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2");
    std::string list, primitives;
    for (size_t i = 0; i < materials.size(); ++i) {
        list += (i ? "," : "") + materials[i];
        primitives += (i ? "," : "") + (R"({"attributes":{"POSITION":0,"TEXCOORD_0":)" + std::to_string(uv)) +
                      R"(},"indices":1,"material":)" + std::to_string(i) + "}";
    }
    gltf.members["materials"] = "[" + list + "]";
    gltf.members["meshes"] = R"([{"primitives":[)" + primitives + "]}]";
    return gltf;
}

std::string textured(int texture, const std::string& more = "") {
    return R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)" + std::to_string(texture) + more + "}}}";
}

// White images of some sizes, with the texture of the same index.
void add_images(GltfBuilder& gltf, const std::vector<ivec2>& sizes) {
    std::string images, textures;
    for (size_t i = 0; i < sizes.size(); ++i) {
        const std::vector<std::array<uint8_t, 4>> texels(sizes[i].x * sizes[i].y, {255, 255, 255, 255});
        images += std::string(i ? "," : "") + R"({"mimeType":"image/png","bufferView":)" +
                  std::to_string(gltf.view(png_of(sizes[i], texels))) + "}";
        textures += std::string(i ? "," : "") + R"({"source":)" + std::to_string(i) + "}";
    }
    gltf.members["images"] = "[" + images + "]";
    gltf.members["textures"] = "[" + textures + "]";
}

Scene loaded(const GltfBuilder& gltf, const LoadOptions& options = {}) {
    const TempFolder folder;
    const LoadResult answer = load(folder.put("scene.gltf", gltf.json()), options);
    EXPECT_TRUE(answer.loaded) << answer.message;
    return answer.scene;
}

ivec2 size_of(const Scene& scene, int material) {
    return scene.textures.at(scene.materials.at(material).base_texture).texels->size();
}

TEST(GltfMaterials, AnImageIsStoredOnceHoweverItIsUsed) {
    GltfBuilder gltf = with_materials(
        {textured(0), textured(1), textured(0, R"(,"extensions":{"KHR_texture_transform":{"scale":[2,2]}})")});
    add_images(gltf, {{4, 4}});
    gltf.members["samplers"] = R"([{"wrapS":33071}])";
    gltf.members["textures"] = R"([{"source":0},{"source":0,"sampler":0}])";
    const Scene scene = loaded(gltf);
    ASSERT_EQ(scene.textures.size(), 3u);
    EXPECT_EQ(scene.textures[0].texels, scene.textures[1].texels);
    EXPECT_EQ(scene.textures[0].texels, scene.textures[2].texels);
    EXPECT_EQ(scene.textures[0].texels->bytes(), 4u * 4 * 4) << "8-bit codes stay as small as they are";
    EXPECT_TRUE(scene.textures[0].repeat_u);
    EXPECT_FALSE(scene.textures[1].repeat_u);
    EXPECT_EQ(scene.textures[2].uv_transform[0].x, 2);
}

// One limit of the side for all: the last floor keeps as much detail as the first.
TEST(GltfMaterials, TexturesBeyondTheMemoryAreReducedEvenly) {
    GltfBuilder gltf = with_materials({textured(0), textured(1), textured(2), textured(3)});
    add_images(gltf, {{16, 16}, {8, 16}, {2, 2}, {16, 16}});
    LoadOptions options;
    options.texture_bytes = 4 * (8 * 8 + 4 * 8 + 2 * 2 + 8 * 8);
    const Scene scene = loaded(gltf, options);
    EXPECT_EQ(size_of(scene, 0), ivec2(8, 8));
    EXPECT_EQ(size_of(scene, 1), ivec2(4, 8));
    EXPECT_EQ(size_of(scene, 2), ivec2(2, 2));
    EXPECT_EQ(size_of(scene, 3), ivec2(8, 8));
    EXPECT_TRUE(has_warning(scene, "3 of 4 images are reduced to at most 8 pixels on a side")) << scene.warnings[0];

    options.texture_bytes = 4 * (2 * 16 * 16 + 8 * 16 + 2 * 2);
    const Scene whole = loaded(gltf, options);
    EXPECT_EQ(size_of(whole, 3), ivec2(16, 16));
    EXPECT_FALSE(has_warning(whole, "reduced"));
}

TEST(GltfMaterials, GlassLetsLightThrough) {
    const auto glass = [](const std::string& factor, const std::string& more = "") {
        return R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":)" + factor + "}}" + more + "}";
    };
    GltfBuilder gltf =
        with_materials({glass("1"), glass("0.25", R"(,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]})"),
                        glass("0"), glass("1", R"(,"emissiveFactor":[1,1,1])"), glass("1", R"(,"alphaMode":"MASK")")});
    gltf.members["extensionsUsed"] = R"(["KHR_materials_transmission"])";
    const Scene scene = loaded(gltf);
    ASSERT_EQ(scene.materials.size(), 5u);
    EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::blend);
    EXPECT_FLOAT_EQ(scene.materials[0].alpha, 0.05f) << "it stays visible";
    EXPECT_FLOAT_EQ(scene.materials[1].alpha, 0.75f) << "opaque materials have no alpha of their own";
    EXPECT_EQ(scene.materials[2].alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(scene.materials[3].alpha_mode, AlphaMode::opaque) << "it stays a light";
    EXPECT_EQ(scene.materials[4].alpha_mode, AlphaMode::mask);
    EXPECT_TRUE(has_warning(scene, "shown as partly transparent, without refraction (2)"));
    EXPECT_TRUE(has_warning(scene, "stay opaque (1)"));
    EXPECT_FALSE(has_warning(scene, "KHR_materials_transmission is ignored"));
}
}
}
