#include "base/error.h"
#include "base/json/json.h"
#include "base/random.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "viewer/editing/editing.h"
#include "viewer/editing/json_text.h"
#include "viewer/editing/scene_text.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// The text after edits that were also made in memory; the two must then say the same.
struct Bench {
    SceneFolder studio;
    std::string text;
    Scene scene;
    std::vector<Edit> edits;

    explicit Bench(std::string_view source = rich_scene)
        : studio(source), text(source), scene(load_scene(studio.file)) {}

    void set(std::string_view path, std::string_view value, double seconds = 0) {
        for (const Edit& edit : apply(scene, parse_edit(scene, path, value, seconds))) edits.push_back(edit);
    }
    std::string written() const { return edited_text(text, scene, edits); }
    Scene read() const { return load_scene(studio.put("scene.json", written())); }
};

}

TEST(SceneText, ChangesTheBytesOfTheValueOnly) {
    Bench bench;
    bench.set("exposure", "1.25");
    bench.set("lights/evening/direction", "0.78 -0.5 0.15");
    bench.set("media/0/extinction", "0.2"); // is what it says already: 0.20
    bench.set("ambient", "0.02 0.03 0.04");
    bench.set("lights/evening/color", "0.5");
    std::string expected = replaced(rich_scene, "0.50", "1.25");
    expected = replaced(expected, "[0.78, -0.42, 0.15]", "[0.78, -0.5, 0.15]");
    expected = replaced(expected, "\"ambient\": 0.02", "\"ambient\": [0.02, 0.03, 0.04]");
    expected = replaced(expected, "\"color\": 1,", "\"color\": 0.5,");
    EXPECT_EQ(bench.written(), expected);
    EXPECT_EQ(state_of(bench.read()), state_of(bench.scene));
}

TEST(SceneText, ChangesAndInsertsKeys) {
    Bench bench;
    bench.set("lights/3/intensity", "11", 0.5);
    bench.set("lights/3/intensity", "8", 3.5);
    bench.set("lights/3/intensity", "10.5", 0);
    bench.set("lights/stage/outer_cone", "20", 2);
    bench.set("lights/stage/target", "0 0 0.5", 0);
    std::string expected = replaced(rich_scene, "[0.5, 1.2e1]", "[0.5, 11]");
    expected = replaced(expected, "[2, 10]]", "[1.5, 8], [2, 10.5]]");
    expected = replaced(expected, "[[0, 10]", "[[0, 10.5]");
    expected = replaced(expected, "[1, 16]]", "[1, 16], [2, 20]]");
    expected = replaced(expected, "[[0, [0, 0, 0]], [0.5, [1", "[[0, [0, 0, 0.5]], [0.5, [1");
    EXPECT_EQ(bench.written(), expected);
    EXPECT_EQ(state_of(bench.read()), state_of(bench.scene));
}

TEST(SceneText, InsertsMissingMembersAsTheirNeighborsAre) {
    Bench bench;
    bench.set("lights/stage/volume_scale", "2");
    bench.set("media/dust/wind", "0 0 1");
    bench.set("background/sky/ground", "0.1 0.2 0.3");
    std::string expected =
        replaced(rich_scene, "\"interpolation\": \"step\" }", "\"interpolation\": \"step\" }, \"volume_scale\": 2");
    expected = replaced(expected, "\"fog/dust.json\"", "\"fog/dust.json\", \"wind\": [0, 0, 1]");
    expected = replaced(expected, "[0.5, 0.5, 0.5]", "[0.5, 0.5, 0.5], \"ground\": [0.1, 0.2, 0.3]");
    EXPECT_EQ(bench.written(), expected);
    EXPECT_EQ(state_of(bench.read()), state_of(bench.scene));
}

TEST(SceneText, LightsOfTheModelGetAnEntry) {
    Bench bench;
    bench.set("lights/Spot~11/intensity", "77");
    bench.set("lights/Spot~11/position", "1 2 3");
    bench.set("lights/Sun/direction", "0 -1 0.25");
    bench.set("lights/Moving/color", "1 0.5 0.25");
    const std::string text = bench.written();
    EXPECT_NE(text.find("\"angle\": 0.27 },\n    { \"name\": \"Spot/1\", \"intensity\": 77, \"position\": [1, 2, 3], "),
              text.npos)
        << text;
    EXPECT_EQ(state_of(bench.read()), state_of(bench.scene));
}

TEST(SceneText, ListsAndSectionsThatAreMissingAreMade) {
    const std::string plain = "{\r\n\t\"tyndall\": 1,\r\n\t\"gltf\": \"room.gltf\"\r\n}";
    Bench bench(plain);
    bench.set("lights/Sun/intensity", "5");
    bench.set("background/color", "0.1");
    bench.set("cameras/default/vertical_fov", "50");
    bench.set("exposure", "-2");
    const std::string text = bench.written();
    EXPECT_NE(text.find("\"lights\": [\r\n\t\t{ \"name\": \"Sun\", \"intensity\": 5 }\r\n\t],\r\n"), text.npos) << text;
    EXPECT_NE(text.find("\r\n\t\"background\": { \"color\": 0.1 },\r\n"), text.npos) << text;
    EXPECT_NE(text.find("\r\n\t\"exposure\": -2\r\n}"), text.npos) << text;
    EXPECT_EQ(text.find("\n\n"), text.npos);
    EXPECT_EQ(state_of(bench.read()), state_of(bench.scene));

    Bench one_line("{\"tyndall\":1,\"gltf\":\"room.gltf\"}");
    one_line.set("lights/Sun/intensity", "5");
    EXPECT_EQ(one_line.written(),
              "{\"tyndall\":1,\"gltf\":\"room.gltf\",\"lights\":[{ \"name\": \"Sun\", \"intensity\": 5 }]}");
}

// Both ends of what each property allows must be good in a scene file too.
TEST(SceneText, TheLimitsOfTheTableAreThoseOfTheSchema) {
    const Bench start;
    const auto try_value = [&](const Property& property, size_t index, float value) {
        const Edit edit{property.part, index, property.name, vec3(value), 0};
        Scene scene = start.scene;
        std::vector<Edit> singles;
        try {
            singles = apply(scene, edit);
        } catch (const Error&) {
            return false; // neighbors forbid it
        }
        EXPECT_NO_THROW(edited_text(start.text, scene, singles))
            << part_path(scene, edit.part, index) << property.name << value;
        return true;
    };
    int tried = 0;
    for (const Part part : {Part::light, Part::medium, Part::camera, Part::scene})
        for (size_t i = 0; i < count_of(start.scene, part); ++i)
            for (const Property* property : properties_of(start.scene, part, i))
                tried += try_value(*property, i, property->min_value) + try_value(*property, i, property->max_value);
    EXPECT_GT(tried, 130);
}

// Random edits on random lines of life: what was saved and read again is what was seen.
TEST(SceneText, RandomEditsReadBackAsTheyWereInMemory) {
    const std::vector<std::string> sources{
        rich_scene,
        "{\"tyndall\":1,\"gltf\":\"room.gltf\",\"media\":[{\"type\":\"noise\",\"recipe\":\"fog/dust.json\"},"
        "{\"type\":\"height\",\"extinction\":1e-1,\"falloff\":{\"keys\":[[1,2]]}}]}",
        "\xef\xbb\xbf{\r\n    \"tyndall\": 1, // one\r\n    \"lights\": [ ],\r\n    \"gltf\": \"room.gltf\",\r\n"
        "    \"background\": {\"image\": \"back.png\"} /* end */\r\n}\r\n"};
    uint32_t counter = 0;
    const auto random = [&] { return to_unit(hash(counter++, 99u)); };
    int made = 0;
    for (int trial = 0; trial < 24; ++trial) {
        std::string source = sources[trial % sources.size()];
        if (source.find("back.png") != source.npos)
            source = replaced(source, "{\"image\": \"back.png\"}", "{\"color\": 0}");
        Bench bench(source);
        for (int i = 0; i < 25; ++i) {
            const Part part = static_cast<Part>(static_cast<int>(random() * 4));
            const size_t count = count_of(bench.scene, part);
            if (count == 0) continue;
            const size_t index = static_cast<size_t>(random() * static_cast<float>(count));
            const auto properties = properties_of(bench.scene, part, index);
            if (properties.empty()) continue;
            const Property& property =
                *properties[static_cast<size_t>(random() * static_cast<float>(properties.size()))];
            const auto value = [&] {
                const float share = random();
                if (property.kind == ValueKind::toggle) return share < 0.5f ? 0.0f : 1.0f;
                return property.slider_low + share * (property.slider_high - property.slider_low);
            };
            Edit edit{part, index, property.name, {value(), value(), value()}, 0};
            if (property.kind == ValueKind::color && random() < 0.3f) edit.value = vec3(edit.value.x);
            edit.seconds = random() < 0.5f ? std::floor(random() * 8) / 2 - 1 : 6 * random() - 2;
            try {
                for (const Edit& single : apply(bench.scene, edit)) bench.edits.push_back(single);
                ++made;
            } catch (const Error&) {}
        }
        ASSERT_EQ(state_of(bench.read()), state_of(bench.scene)) << bench.written();
        parse_json(bench.written(), "written");
    }
    EXPECT_GT(made, 400);
}

TEST(SceneText, EveryPathOfASceneIsMoved) {
    const TempFolder scratch;
    std::filesystem::create_directories(scratch.path() / "deep");
    const std::string text =
        rebase_paths(R"({"lights": [{"name": "file", "image": "a.hdr", "ies": {"file": "b.ies"}, "gobo":
        {"image": "c.####.png"}}], "media": [{"file": "d.vdb", "phase": {"mix": [{"file": "e.txt"}]}, "grids": {"albedo":
        {"grid": "file", "file": "f.vdb"}}, "recipe": "/g.json"}]})",
                     scratch.path(), scratch.path() / "deep");
    for (const char* moved : {"\"../a.hdr\"", "\"../b.ies\"", "\"../c.####.png\"", "\"../d.vdb\"", "\"../e.txt\"",
                              "\"../f.vdb\"", "\"name\": \"file\"", "\"grid\": \"file\"", "\"/g.json\""})
        EXPECT_NE(text.find(moved), text.npos) << moved << " in " << text;
}

TEST(SceneText, PathsMeanTheSameFilesFromAnotherFolder) {
    Bench bench;
    const std::filesystem::path folder = bench.studio.path();
    std::filesystem::create_directories(folder / "other/deep");
    const std::string text = rebase_paths(rich_scene, folder, folder / "other/deep");
    EXPECT_NE(text.find("\"gltf\": \"../../room.gltf\""), text.npos);
    EXPECT_NE(text.find("\"recipe\": \"../../fog/dust.json\""), text.npos);
    EXPECT_EQ(state_of(load_scene(bench.studio.put("other/deep/scene.json", text))), state_of(bench.scene));
    EXPECT_EQ(rebase_paths(rich_scene, folder, folder / "other/.."), rich_scene);
}
}
