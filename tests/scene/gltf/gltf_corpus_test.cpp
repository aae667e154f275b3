// glTF files by others: what is right loads, what is wrong is refused in one line or loads without harm.
#include "base/io/file.h"
#include "base/io/json.h"
#include "support/load_answer.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tyndall {
namespace {
namespace fs = std::filesystem;

std::vector<fs::path> gltf_files(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// What every scene must hold, whatever file it came from.
void expect_sound(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        for (const vec3 position : mesh.positions) ASSERT_TRUE(is_finite(position));
        for (const vec3 normal : mesh.normals) ASSERT_NEAR(glm::length(normal), 1, 1e-4);
        ASSERT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
        ASSERT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
        ASSERT_TRUE(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());
        for (const glm::uvec3& triangle : mesh.triangles)
            ASSERT_LT(std::max({triangle.x, triangle.y, triangle.z}), mesh.positions.size());
        ASSERT_LT(mesh.material, static_cast<int>(scene.materials.size()));
    }
    for (size_t i = 0; i < scene.nodes.size(); ++i) ASSERT_LT(scene.nodes[i].parent, static_cast<int>(i));
    for (const Instance& instance : scene.instances) {
        ASSERT_LT(instance.mesh, static_cast<int>(scene.meshes.size()));
        const mat4 place = node_matrix(scene, instance.node, 0.5);
        for (int i = 0; i < 16; ++i) ASSERT_TRUE(std::isfinite(place[i / 4][i % 4]));
    }
    for (const Material& material : scene.materials) {
        ASSERT_LT(material.base_texture, static_cast<int>(scene.textures.size()));
        ASSERT_LT(material.emission_texture, static_cast<int>(scene.textures.size()));
    }
    for (const std::string& warning : scene.warnings) expect_one_line(warning);
    ASSERT_FALSE(scene.cameras.empty());
}

class GltfCorpus : public testing::Test {
protected:
    void SetUp() override {
        if (!fs::is_directory(corpus)) GTEST_SKIP() << "no glTF files by others at " << corpus;
    }
    const fs::path corpus = fs::path(TYNDALL_SHARED_DATA) / "gltf";
};

TEST_F(GltfCorpus, RealFilesLoad) {
    int count = 0;
    for (const char* source : {"bevy", "blender-io", "godot", "khronos", "rayferric"}) {
        if (!fs::is_directory(corpus / source)) continue;
        for (const fs::path& file : gltf_files(corpus / source)) {
            SCOPED_TRACE(file.string());
            const LoadAnswer answer = load(file);
            if (file.string().find("Draco") != std::string::npos) {
                expect_refusal(answer, "KHR_draco_mesh_compression");
                continue;
            }
            EXPECT_TRUE(answer.loaded) << answer.message;
            expect_sound(answer.scene);
            ++count;
        }
    }
    EXPECT_GE(count, 50);
}

TEST_F(GltfCorpus, MalformedFilesDoNoHarm) {
    int right = 0, wrong = 0;
    for (const fs::path& file : gltf_files(corpus / "malformed")) {
        SCOPED_TRACE(file.string());
        const LoadAnswer answer = load(file);
        if (answer.loaded)
            expect_sound(answer.scene);
        else
            expect_one_line(answer.message);

        const fs::path report = file.string() + ".report.json";
        if (!fs::exists(report)) continue;
        const Json verdict = parse_json(read_file(report), report.string());
        // Two things the validator lets pass are refused: an element type of the future, and a file on the network.
        const std::string place = file.parent_path().filename().string() + "/" + file.stem().string();
        const bool good = verdict.find("issues")->number_or("numErrors", 0) == 0 && place != "accessor/unknown_type" &&
                          place != "buffer/non_relative_uri";
        EXPECT_TRUE(answer.loaded || !good) << answer.message;
        ++(good ? right : wrong);
    }
    EXPECT_GE(right, 20);
    EXPECT_GE(wrong, 40);
}

TEST_F(GltfCorpus, TwoWaysToStoreOneModelAgree) {
    for (const char* model : {"Box", "BoxAnimated", "BoxVertexColors", "OrientationTest", "RiggedSimple"}) {
        const fs::path folder = corpus / "khronos" / model;
        const LoadAnswer text = load(folder / "glTF" / (std::string(model) + ".gltf"));
        const LoadAnswer binary = load(folder / "glTF-Binary" / (std::string(model) + ".glb"));
        const LoadAnswer embedded = load(folder / "glTF-Embedded" / (std::string(model) + ".gltf"));
        ASSERT_TRUE(text.loaded && binary.loaded && embedded.loaded) << model;
        for (const Scene* other : {&binary.scene, &embedded.scene}) {
            ASSERT_EQ(text.scene.meshes.size(), other->meshes.size());
            for (size_t i = 0; i < other->meshes.size(); ++i) {
                EXPECT_EQ(text.scene.meshes[i].positions, other->meshes[i].positions);
                EXPECT_EQ(text.scene.meshes[i].triangles, other->meshes[i].triangles);
            }
        }
    }
}
}
}
