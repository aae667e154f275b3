// Broken and hostile glTF: every field out of its range, cycles, ways out of the folder, cut and mutated files.
#include "base/random.h"
#include "scene/images.h"
#include "support/expect.h"
#include "support/gltf_builder.h"
#include "support/load_answer.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

namespace tyndall {
namespace {
// The triangle with one member's text replaced.
LoadResult with(const std::string& member, const std::string& value, const TempFolder& folder,
                GltfBuilder gltf = triangle_gltf()) {
    gltf.members[member] = value;
    return load(folder.put("bad.gltf", gltf.json()));
}

TEST(GltfErrors, EveryFieldOutOfRange) {
    const TempFolder folder;
    const GltfBuilder good = triangle_gltf();
    ASSERT_TRUE(load(folder.put("good.gltf", good.json())).loaded);
    const std::pair<const char*, std::vector<const char*>> fields[] = {
        {"\"bufferView\":0", {"2", "2147483648", "9223372036854775808", "-1", "0.5", "\"0\"", "null", "1e300", "[]"}},
        {"\"componentType\":5126", {"5124", "5130", "0", "-1", "5126.5", "\"5126\"", "4294967296"}},
        {"\"count\":3",
         {"4", "1000000000", "2147483648", "9223372036854775808", "1.8446744073709552e19", "0", "-1", "0.5", "\"3\""}},
        {"\"type\":\"VEC3\"", {"\"VEC5\"", "\"SCALAR\"", "3", "null"}},
        {"\"byteOffset\":0",
         {"16", "4096", "2147483648", "9223372036854775808", "18446744073709551615", "-1", "0.5", "true"}},
        {"\"byteLength\":36", {"3600", "2147483648", "4611686018427387904", "-1", "0", "0.5", "\"36\""}},
        {"\"buffer\":0", {"1", "2147483648", "-1", "0.5", "\"0\""}},
        {"\"POSITION\":0", {"2", "99", "-1", "2147483648", "0.5", "\"0\"", "1"}},
        {"\"indices\":1", {"2", "-1", "4294967297", "0.5", "0", "\"1\""}},
        {"\"nodes\":[0]", {"[1]", "[-1]", "[4294967296]", "[0.5]", "0", "[\"0\"]"}},
        {"\"mesh\":0", {"1", "-1", "2147483648", "0.5", "\"0\"", "{}"}},
        {"\"version\":\"2.0\"", {"\"1.0\"", "\"3.0\"", "2.0", "\"\""}},
    };
    for (const auto& [field, values] : fields)
        for (const char* value : values) {
            SCOPED_TRACE(std::string(field) + " becomes " + value);
            const std::string name(field, std::string_view(field).find(':') + 1);
            const LoadResult answer = load(folder.put("bad.gltf", replaced(good.json(), field, name + value)));
            expect_refusal(answer, "bad.gltf: /");
        }
}

TEST(GltfErrors, StridesAndSparse) {
    const TempFolder folder;
    const std::string view =
        R"([{"buffer":0,"byteLength":36,"byteStride":STRIDE},{"buffer":0,"byteOffset":36,"byteLength":6}])";
    for (const char* stride : {"0", "4", "8", "13", "256", "-4", "1.5", "16"})
        expect_refusal(with("bufferViews", replaced(view, "STRIDE", stride), folder), "bad.gltf: /");

    const auto sparse = [&](const std::string& text) {
        GltfBuilder gltf = triangle_gltf();
        gltf.view(std::string("\x09\0", 2));
        gltf.accessors[0] = replaced(gltf.accessors[0], "{", R"({"sparse":)" + text + ",");
        return load(folder.put("bad.gltf", gltf.json()));
    };
    const std::string values = R"("values":{"bufferView":0}})";
    expect_refusal(sparse(R"({"count":1,"indices":{"bufferView":2,"componentType":5123},)" + values), "element 9");
    expect_refusal(sparse(R"({"count":2,"indices":{"bufferView":2,"componentType":5123},)" + values),
                   "/accessors/0/sparse/indices");
    expect_refusal(sparse(R"({"count":9,"indices":{"bufferView":2,"componentType":5123},)" + values),
                   "/accessors/0/sparse/count");
    expect_refusal(sparse(R"({"count":1,"indices":{"bufferView":2,"componentType":5126},)" + values),
                   "/accessors/0/sparse/indices/componentType");
    expect_refusal(sparse(R"({"count":1,"indices":{"bufferView":7,"componentType":5123},)" + values),
                   "/accessors/0/sparse/indices/bufferView");
    expect_refusal(sparse(R"({"count":1})"), "/accessors/0/sparse");
}

TEST(GltfErrors, IndicesBeyondTheVertices) {
    const TempFolder folder;
    for (const uint16_t index : {3, 255, 65535}) {
        GltfBuilder gltf = triangle_gltf();
        gltf.binary.replace(36, 6,
                            std::string("\0\0\1\0", 4) + static_cast<char>(index) + static_cast<char>(index >> 8));
        expect_refusal(load(folder.put("bad.gltf", gltf.json())), "/meshes/0/primitives/0/indices");
    }
    GltfBuilder gltf = triangle_gltf();
    gltf.floats({1, 2}, "VEC2");
    gltf.members["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1}]}])";
    expect_refusal(load(folder.put("bad.gltf", gltf.json())), "TEXCOORD_0");
}

TEST(GltfErrors, HugeCountsCostNothing) {
    const TempFolder folder;
    // Zeros without data, and a sparse accessor over nothing: a billion of either.
    expect_refusal(
        with(
            "accessors",
            R"([{"componentType":5126,"count":1000000000,"type":"VEC3"},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}])",
            folder),
        "/accessors/0/count");
    expect_refusal(with("buffers", R"([{"byteLength":9007199254740000,"uri":"a.bin"}])", folder), "/buffers/0");
    expect_refusal(with("buffers", R"([{"byteLength":5,"uri":"data:;base64,AAAAAA"}])", folder),
                   "/buffers/0/byteLength");
    expect_refusal(with("buffers", R"([{"byteLength":5,"uri":"data:;base64,A*AAAAAA"}])", folder), "/buffers/0/uri");
    expect_refusal(with("buffers", R"([{"byteLength":5,"uri":"data:nonsense"}])", folder), "/buffers/0/uri");
    // A sparse file of 20 GB beside a buffer of 42 bytes.
    const auto big = folder.put("big.bin", "");
    std::filesystem::resize_file(big, uint64_t{20} << 30);
    expect_refusal(with("buffers", R"([{"byteLength":42,"uri":"big.bin"}])", folder), "/buffers/0/uri");
}

TEST(GltfErrors, NodesMustBeAForest) {
    const TempFolder folder;
    const auto chain = [](int count, const std::string& last) {
        std::string text = "[";
        for (int i = 0; i + 1 < count; ++i) text += R"({"children":[)" + std::to_string(i + 1) + "]},";
        return text + last + "]";
    };
    for (const int length : {1, 2, 1000})
        expect_refusal(with("nodes", chain(length, R"({"children":[0]})"), folder), "/nodes/0");
    expect_refusal(with("nodes", R"([{},{"children":[2,2]},{}])", folder), "/nodes/1/children/1");
    expect_refusal(with("nodes", R"([{"children":[2]},{"children":[2]},{}])", folder), "/nodes/1/children/0");
    expect_refusal(with("nodes", R"([{},{"children":[2]},{"children":[3]},{"children":[1]}])", folder), "/nodes/1");
    EXPECT_TRUE(with("nodes", chain(256, R"({"mesh":0})"), folder).loaded) << "256 levels are allowed";
    expect_refusal(with("nodes", chain(257, "{}"), folder), "256");
    expect_refusal(with("nodes", chain(100000, "{}"), folder), "256");
    // Sixty levels of two children that are one: 2^60 paths.
    std::string diamond = "[";
    for (int i = 0; i < 60; ++i)
        diamond += R"({"children":[)" + std::to_string(i + 1) + "," + std::to_string(i + 1) + "]},";
    expect_refusal(with("nodes", diamond + "{}]", folder), "/nodes/0/children/1");
    expect_refusal(with("scenes", R"([{"nodes":[1]}])", folder,
                        [] {
                            GltfBuilder gltf = triangle_gltf();
                            gltf.members["nodes"] = R"([{"children":[1]},{}])";
                            return gltf;
                        }()),
                   "/scenes/0/nodes/0");
}

TEST(GltfErrors, PlacesThatAreNoPlaces) {
    const TempFolder folder;
    for (const char* node : {R"({"matrix":[1,2,3]})", R"({"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,1e300,1]})",
                             R"({"translation":[0,1e39,0]})", R"({"translation":[0,0]})", R"({"rotation":[0,0,0]})",
                             R"({"scale":[1,"1",1]})", R"({"translation":"here"})"})
        expect_refusal(with("nodes", "[" + std::string(node) + "]", folder), "/nodes/0/");
    expect_refusal(with("nodes", R"([{"translation":[0,1e400,0]}])", folder), "bad.gltf");

    // Harmless ones are used with a warning.
    for (const auto& [node, warning] : std::map<std::string, const char*>{
             {R"({"mesh":0,"rotation":[0,0,0,0]})", "zero or non-finite length"},
             {R"({"mesh":0,"scale":[1,0,1]})", "a scale of 0"},
             {R"({"mesh":0,"matrix":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1]})", "a scale of 0"},
             {R"({"mesh":0,"matrix":[1,0,0,0.5,0,1,0,0,0,0,1,0,0,0,0,1]})", "perspective"}}) {
        const LoadResult answer = with("nodes", "[" + node + "]", folder);
        EXPECT_TRUE(answer.loaded) << answer.message;
        EXPECT_TRUE(has_warning(answer.scene, warning)) << node;
        EXPECT_TRUE(std::isfinite(node_matrix(answer.scene, 0, 0)[3].x));
    }
}

TEST(GltfErrors, DeepNestingEndsEarly) {
    const TempFolder folder;
    for (const char* key : {"extras", "extensions", "nodes", "anything"}) {
        for (const char bracket : {'[', '{'}) {
            std::string deep;
            for (int i = 0; i < 1000000; ++i) deep += bracket == '[' ? "[" : "{\"a\":";
            expect_refusal(with(key, deep, folder), "bad.gltf");
        }
    }
}

// The canary has just the bytes the buffer needs: were it opened, the file would load.
TEST(GltfErrors, NothingOutsideTheFolderIsOpened) {
    const TempFolder folder;
    GltfBuilder gltf = triangle_gltf();
    const std::string canary = folder.put("secret.bin", gltf.binary).string();
    folder.put("in/near.bin", gltf.binary);
    std::filesystem::create_symlink("../secret.bin", folder / "in/out.bin");
    std::filesystem::create_symlink("near.bin", folder / "in/same.bin");
    std::filesystem::create_directory_symlink("..", folder / "in/up");
    const auto buffer_at = [&](const std::string& uri) {
        gltf.members["buffers"] =
            R"([{"byteLength":)" + std::to_string(gltf.binary.size()) + R"(,"uri":")" + uri + "\"}]";
        return load(folder.put("in/bad.gltf", gltf.json()));
    };
    for (const std::string& uri :
         {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"), std::string("%2E%2e%2fsecret.bin"),
          std::string("a/../../secret.bin"), std::string("..\\\\secret.bin"), canary, "file://" + canary,
          "file:" + canary, std::string("http://localhost/secret.bin"), std::string("C:/secret.bin"),
          std::string("%2fetc/passwd"), std::string("near.bin%00"), std::string("near%0a.bin"), std::string(""),
          std::string("out.bin"), std::string("up/secret.bin")}) {
        SCOPED_TRACE(uri);
        expect_refusal(buffer_at(uri), "/buffers/0/uri");
    }
    for (const char* uri : {"%252e%252e/secret.bin", "no.bin", "secret.bin"})
        expect_refusal(buffer_at(uri), "/buffers/0/uri", ExitCode::unreadable);
    EXPECT_TRUE(buffer_at("near.bin").loaded);
    EXPECT_TRUE(buffer_at("same.bin").loaded) << "a link that stays inside";

    // A file of that name in the working directory is not the one beside the glTF.
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder / ".");
    expect_refusal(buffer_at("secret.bin"), "/buffers/0/uri", ExitCode::unreadable);
    std::filesystem::current_path(before);
}

TEST(GltfErrors, OnlyRegularFiles) {
    const TempFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe.bin").c_str(), 0600), 0);
    std::filesystem::create_directory(folder / "folder.bin");
    for (const char* uri : {"pipe.bin", "folder.bin", "."})
        expect_refusal(with("buffers", R"([{"byteLength":42,"uri":")" + std::string(uri) + "\"}]", folder),
                       "/buffers/0/uri", ExitCode::unreadable);
}

TEST(GltfErrors, ImagesCannotHurt) {
    const TempFolder folder;
    GltfBuilder gltf = triangle_gltf();
    const int uv = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2");
    gltf.members["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":)" + std::to_string(uv) +
                             R"(},"indices":1,"material":0}]}])";
    gltf.members["materials"] =
        R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"normalTexture":{"index":1}}])";
    gltf.members["textures"] = R"([{"source":0},{"source":1}])";
    const auto image = [&](const std::string& text) {
        gltf.members["images"] = "[" + text + R"(,{"uri":"../never opened.png"}])";
        return load(folder.put("bad.gltf", gltf.json()));
    };
    const auto data = [](const std::string& bytes) {
        return R"({"uri":"data:image/png;base64,)" + base64(bytes) + "\"}";
    };
    const std::string good = png_of({2, 2}, std::vector<std::array<uint8_t, 4>>(4));
    EXPECT_EQ(image(data(good)).scene.textures.size(), 1u);
    for (const std::string& bytes :
         {std::string("GIF89a\1\0\1\0"), std::string("#?RADIANCE\n"), good.substr(0, 30), good.substr(0, 60),
          png_of({20000, 20000}, {}), png_of({16777217, 1}, {}), std::string("\xff\xd8\xff\xe0 cut"), std::string()}) {
        const LoadResult answer = image(data(bytes));
        EXPECT_TRUE(answer.loaded) << answer.message;
        EXPECT_TRUE(has_warning(answer.scene, "/images/0")) << bytes.substr(0, 8);
        EXPECT_TRUE(answer.scene.textures.empty());
        for (const std::string& warning : answer.scene.warnings) expect_one_line(warning);
    }
    expect_refusal(image(R"({"bufferView":99,"mimeType":"image/png"})"), "/images/0/bufferView");
    expect_refusal(image(R"({"uri":"../secret.png"})"), "/images/0/uri");
    expect_refusal(image(R"({"uri":"a.png","bufferView":0})"), "/images/0");
    expect_refusal(image("{}"), "/images/0");
}

TEST(GltfErrors, ExtensionsThatAreNeeded) {
    const TempFolder folder;
    expect_refusal(with("extensionsRequired", R"(["KHR_draco_mesh_compression"])", folder),
                   "compressed with KHR_draco_mesh_compression");
    expect_refusal(with("extensionsRequired", R"(["EXT_meshopt_compression"])", folder), "EXT_meshopt_compression");
    expect_refusal(with("extensionsRequired", R"(["KHR_texture_transform","ACME_wormhole"])", folder),
                   "/extensionsRequired/1");
    expect_refusal(with("extensionsRequired", R"("KHR_texture_transform")", folder), "/extensionsRequired");
    for (const char* fine :
         {"KHR_texture_transform", "KHR_mesh_quantization", "KHR_materials_unlit", "KHR_lights_punctual"})
        EXPECT_TRUE(with("extensionsRequired", "[\"" + std::string(fine) + "\"]", folder).loaded) << fine;
    const LoadResult optional = with("extensionsUsed", R"(["ACME_wormhole"])", folder);
    EXPECT_TRUE(has_warning(optional.scene, "ACME_wormhole"));
}

TEST(GltfErrors, AnimationsThatDoNotFit) {
    const TempFolder folder;
    GltfBuilder gltf = triangle_gltf();
    const int times = gltf.floats({0, 1, 1}, "SCALAR"), moves = gltf.floats({0, 0, 0, 1, 0, 0, 2, 0, 0}, "VEC3");
    const int few = gltf.floats({0, 0, 0}, "VEC3"), broken = gltf.floats({0, NAN, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
    const int never = gltf.floats({0, NAN, 2}, "SCALAR");
    const auto played = [&](int input, int output, const std::string& more, const std::string& sampler = "0") {
        return with("animations",
                    R"([{"channels":[{"sampler":)" + sampler +
                        R"(,"target":{"node":0,"path":"translation"}}],"samplers":[{"input":)" + std::to_string(input) +
                        R"(,"output":)" + std::to_string(output) + more + "}]}]",
                    folder, gltf);
    };
    const LoadResult stuck = played(times, moves, "");
    EXPECT_EQ(stuck.scene.nodes.at(0).translation.times.size(), 2u);
    EXPECT_TRUE(has_warning(stuck.scene, "time does not increase"));
    expect_refusal(played(times, few, ""), "/animations/0/samplers/0/output");
    expect_refusal(played(times, moves, R"(,"interpolation":"CUBICSPLINE")"), "/animations/0/samplers/0/output");
    expect_refusal(played(times, moves, R"(,"interpolation":"BOUNCE")"), "/animations/0/samplers/0/interpolation");
    expect_refusal(played(times, broken, ""), "non-finite");
    expect_refusal(played(never, moves, ""), "non-finite");
    expect_refusal(played(moves, moves, ""), "/animations/0/samplers/0/input");
    expect_refusal(played(times, moves, "", "1"), "/animations/0/channels");
}

TEST(GltfErrors, GlbCutAnywhere) {
    const TempFolder folder;
    const GltfBuilder gltf = triangle_gltf();
    const std::string whole = glb_of(gltf.json(false), gltf.binary);
    // Every place near the start and the end, one in seven between: chunks begin at multiples of four.
    for (size_t size = 0; size < whole.size(); size += size < 64 || size + 64 > whole.size() ? 1 : 7) {
        const LoadResult answer = load(folder.put("cut.glb", whole.substr(0, size)));
        expect_refusal(answer, "cut.glb");
    }
    EXPECT_TRUE(load(folder.put("cut.glb", whole)).loaded);
    const LoadResult longer = load(folder.put("cut.glb", whole + "more"));
    EXPECT_TRUE(longer.loaded && has_warning(longer.scene, "4 bytes after the end"));
}

TEST(GltfErrors, GlbHeadersAndChunks) {
    const TempFolder folder;
    const GltfBuilder gltf = triangle_gltf();
    const std::string json = gltf.json(false), whole = glb_of(json, gltf.binary);
    const auto put = [&](size_t offset, uint32_t value) {
        std::string bytes = whole;
        return bytes.replace(offset, 4, word_bytes(value));
    };
    const size_t second = 20 + (json.size() + 3) / 4 * 4;
    const std::string text = chunk("JSON", json, ' '), data = chunk(std::string_view("BIN\0", 4), gltf.binary, '\0');
    const auto built = [](const std::string& body) {
        return "glTF" + word_bytes(2) + word_bytes(static_cast<uint32_t>(12 + body.size())) + body;
    };
    int without_data = 0;
    for (const std::string& bytes : {put(0, 0x46546C68),
                                     put(4, 1),
                                     put(4, 3),
                                     put(8, 0),
                                     put(8, 19),
                                     put(8, ~0u),
                                     put(12, ~0u),
                                     put(12, 3),
                                     put(12, 0),
                                     put(12, static_cast<uint32_t>(whole.size())),
                                     put(16, 0x004E4942),
                                     put(second, ~0u),
                                     put(second, ~0u - 7),
                                     put(second, static_cast<uint32_t>(gltf.binary.size()) + 8),
                                     put(second, 2),
                                     built(text),
                                     built(data),
                                     built(data + text),
                                     built(text + data + data),
                                     built(text + text),
                                     built(text + data + "abc"),
                                     built(text + data + "abcd")}) {
        const LoadResult answer = load(folder.put("bad.glb", bytes));
        if (answer.loaded) {
            EXPECT_TRUE(has_warning(answer.scene, "no data")) << "a missing chunk leaves the mesh out";
            ++without_data;
        } else {
            expect_refusal(answer, "bad.glb");
        }
    }
    EXPECT_EQ(without_data, 1);
    EXPECT_TRUE(load(folder.put("good.glb", built(text + data + chunk("ABCD", "more", ' ')))).loaded)
        << "unknown chunks are skipped";
    expect_refusal(load(folder.put("lfs.glb", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n")),
                   "Git LFS");
    expect_refusal(load(folder.put("text.gltf", "not json")), "neither");
    expect_refusal(load(folder / "none.glb"), "none.glb", ExitCode::unreadable);
}

// Bytes changed at random: a scene or one line, never anything else. Returns how many were refused.
int refused_mutants(uint32_t first, uint32_t last) {
    const TempFolder folder;
    GltfBuilder gltf = triangle_gltf();
    const int uv = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2"),
              image = gltf.view(png_of({2, 2}, std::vector<std::array<uint8_t, 4>>(4)));
    const int times = gltf.floats({0, 1}, "SCALAR"), moves = gltf.floats({0, 0, 0, 1, 0, 0}, "VEC3");
    gltf.members["images"] = R"([{"bufferView":)" + std::to_string(image) + R"(,"mimeType":"image/png"}])";
    gltf.members["textures"] = R"([{"source":0}])";
    gltf.members["materials"] = R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
    gltf.members["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":)" + std::to_string(uv) +
                             R"(},"indices":1,"material":0}]}])";
    gltf.members["animations"] =
        R"([{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],"samplers":[{"input":)" +
        std::to_string(times) + R"(,"output":)" + std::to_string(moves) + "}]}]";
    const std::string whole = glb_of(gltf.json(false), gltf.binary);
    EXPECT_TRUE(load(folder.put("mutant.glb", whole)).loaded);
    const std::string digits = "0123456789-.,:[]{}\"e";
    int refused = 0;
    for (uint32_t round = first; round < last; ++round) {
        std::string bytes = whole;
        const uint32_t changes = 1 + hash(round, 0u) % 4;
        for (uint32_t i = 0; i < changes; ++i) {
            const size_t place = hash(round, i, 1u) % bytes.size();
            const uint32_t value = hash(round, i, 2u);
            bytes[place] = value & 1 ? digits[(value >> 8) % digits.size()] : static_cast<char>(value >> 8);
        }
        const LoadResult answer = load(folder.put("mutant.glb", bytes));
        if (answer.loaded) continue;
        expect_one_line(answer.message);
        ++refused;
    }
    return refused;
}

TEST(GltfErrors, MutatedFilesEndInOneLine) { EXPECT_GT(refused_mutants(0, 300), 60); }
TEST(GltfErrors, NightlyManyMutatedFiles) { EXPECT_GT(refused_mutants(300, 20000), 4000); }
}
}
