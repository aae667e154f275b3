// glTF files by others: what is right loads, what is wrong is refused in one line or loads without harm.
#include "base/io/file.h"
#include "base/json/json.h"
#include "support/corpus.h"
#include "support/load_answer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace tyndall {
namespace {
namespace fs = std::filesystem;

const std::vector<std::string> extensions = {".gltf", ".glb"};

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

TEST(GltfCorpus, RealFilesLoad) {
    int count = 0;
    for (const fs::path& file : test::corpus_files("gltf", extensions)) {
        if (file.string().find("malformed") != std::string::npos) continue;
        SCOPED_TRACE(file.string());
        const LoadResult answer = load(file);
        if (file.string().find("Draco") != std::string::npos) {
            expect_refusal(answer, "KHR_draco_mesh_compression");
            continue;
        }
        EXPECT_TRUE(answer.loaded) << answer.message;
        expect_sound(answer.scene);
        ++count;
    }
    EXPECT_GE(count, 25);
}

TEST(GltfCorpus, MalformedFilesDoNoHarm) {
    int right = 0, wrong = 0;
    for (const fs::path& file : test::corpus_files("gltf/malformed", extensions)) {
        SCOPED_TRACE(file.string());
        const LoadResult answer = load(file);
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
    EXPECT_GE(right, 12);
    EXPECT_GE(wrong, 30);
}

// A model's folder holds a folder for each way: glTF, glTF-Embedded, glTF-Binary.
TEST(GltfCorpus, WaysToStoreOneModelAgree) {
    std::map<fs::path, std::vector<fs::path>> models;
    for (const fs::path& file : test::corpus_files("gltf/khronos", extensions))
        if (file.string().find("Draco") == std::string::npos) models[file.parent_path().parent_path()].push_back(file);
    int compared = 0;
    for (const auto& [folder, files] : models) {
        SCOPED_TRACE(folder.string());
        const LoadResult first = load(files[0]);
        ASSERT_TRUE(first.loaded) << first.message;
        for (size_t way = 1; way < files.size(); ++way, ++compared) {
            const LoadResult other = load(files[way]);
            ASSERT_TRUE(other.loaded) << other.message;
            ASSERT_EQ(first.scene.meshes.size(), other.scene.meshes.size());
            for (size_t i = 0; i < first.scene.meshes.size(); ++i) {
                EXPECT_EQ(first.scene.meshes[i].positions, other.scene.meshes[i].positions);
                EXPECT_EQ(first.scene.meshes[i].triangles, other.scene.meshes[i].triangles);
            }
        }
    }
    EXPECT_GE(compared, 5);
}
}
}
