// Units of lights: what a scene file says against the light that leaves.
#include "base/io/file.h"
#include "scene/light.h"
#include "scene/photometry/light_power.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "support/load_answer.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
constexpr double sphere = 4 * 3.14159265358979323846;

Scene scene_with(const std::string& light, const std::string& more = "") {
    return load_scene_text("{\"tyndall\": 1, " + more + "\"lights\": [" + light + "]}", "scene.json");
}
float candela(const std::string& light, double seconds = 0) { return candela_of(scene_with(light).lights[0], seconds); }
std::string spot(const std::string& more) {
    return R"({"type": "spot", "position": [0,1,0], "direction": [0,-1,0], "inner_cone": 20, "outer_cone": 30, )" +
           more + "}";
}
std::string point(const std::string& more) { return R"({"type": "point", "position": [0,1,0], )" + more + "}"; }
std::string refusal(const std::string& light) {
    return error_message(ExitCode::refused, [&] { scene_with(light); });
}

TEST(LightPower, LumensOfAConeAreTheIntegralOfItsFalloff) {
    for (const vec2 cone :
         {vec2(0, 0.785f), vec2(0.2f, 0.3f), vec2(0.3f, 0.3f), vec2(0, 1.5707f), vec2(0.001f, 0.0011f)}) {
        Light light;
        light.kind = LightKind::spot, light.inner_cone = cone.x, light.outer_cone = cone.y;
        const ConeFalloff falloff = cone_falloff(light);
        constexpr int n = 200000;
        const double low = std::cos(double{cone.y}), width = (1 - low) / n;
        double sum = 0;
        for (int i = 0; i < n; ++i) sum += falloff.at(static_cast<float>(low + (i + 0.5) * width)) * width;
        EXPECT_NEAR(cone_lumens(double{cone.x}, double{cone.y}) / (2 * double{pi} * sum), 1,
                    cone.y < 0.01f ? 0.1 : 1e-3)
            << cone.y;
    }
}

TEST(LightPower, LumensAndWattsBecomeCandela) {
    EXPECT_EQ(candela(point(R"("intensity": 7)")), 7);
    EXPECT_NEAR(candela(point(R"("intensity": 800, "unit": "lumen")")), 800 / sphere, 1e-3);
    EXPECT_NEAR(candela(point(R"("intensity": 60, "unit": "watt", "efficacy": 15)")), 900 / sphere, 1e-3);
    // Blender 3.4 writes 54351.4 candela for 1000 W.
    EXPECT_NEAR(candela(point(R"("intensity": 1000, "unit": "watt", "efficacy": 683)")), 54351.4, 0.1);
    const double lumens = cone_lumens(glm::radians(20.0), glm::radians(30.0));
    EXPECT_NEAR(candela(spot(R"("intensity": 800, "unit": "lumen")")), 800 / lumens, 1e-2);
    EXPECT_NEAR(candela(spot(R"("intensity": 800, "unit": "lumen", "spread": "sphere")")), 800 / sphere, 1e-3);
    const char* sun = R"({"type": "sun", "direction": [0,-1,0], "intensity": 3, "unit": "watt", "efficacy": 683})";
    EXPECT_NEAR(candela(sun), 2049, 1e-2);
    // A cone that opens spreads the same lumens.
    const char* opening =
        R"({"type": "spot", "position": [0,1,0], "direction": [0,-1,0], "intensity": 100, "unit": "lumen",
        "inner_cone": 0, "outer_cone": {"keys": [[0, 10], [1, 20]]}})";
    EXPECT_NEAR(candela(opening, 0) / candela(opening, 1),
                cone_lumens(0, glm::radians(20.0)) / cone_lumens(0, glm::radians(10.0)), 1e-3);
}

TEST(LightPower, FacesGlowInNitsLumensAndCandela) {
    const std::string
        board = R"({"type": "rectangle", "position": [0,1,0], "direction": [0,-1,0], "width": 2, "height": 0.5, )",
        disc = R"({"type": "disc", "position": [0,1,0], "direction": [0,-1,0], "radius": 0.5, )",
        ball = R"({"type": "sphere", "position": [0,1,0], "radius": 0.5, )";
    const auto nits = [](const std::string& light) { return native_intensity(scene_with(light + "}").lights[0], 0); };
    constexpr double quarter = 0.25 * double{pi}; // m² of disc and ball, seen along the axis
    for (const std::string& face : {board, disc, ball}) EXPECT_NEAR(nits(face + R"("intensity": 7)"), 7, 1e-5);
    EXPECT_NEAR(candela(board + R"("intensity": 7})"), 7, 1e-5);
    EXPECT_NEAR(nits(disc + R"("intensity": 7, "unit": "candela")"), 7 / quarter, 1e-5);
    // A Lambert face sends π times its radiance and area.
    EXPECT_NEAR(nits(board + R"("intensity": 800, "unit": "lumen")"), 800 / double{pi}, 1e-3);
    EXPECT_NEAR(nits(board + R"("intensity": 800, "unit": "lumen", "two_sided": true)"), 400 / double{pi}, 1e-3);
    EXPECT_NEAR(nits(disc + R"("intensity": 40, "unit": "watt", "efficacy": 20)"), 800 / (double{pi} * quarter), 1e-3);
    EXPECT_NEAR(nits(ball + R"("intensity": 800, "unit": "lumen")"), 800 / (double{pi} * 4 * quarter), 1e-3);
    EXPECT_NEAR(nits(ball + R"("intensity": 10, "exposure": 2)"), 40, 1e-4);
    EXPECT_NE(refusal(ball + R"("intensity": 5, "unit": "lux"})").find("nit, candela, lumen or watt"),
              std::string::npos);
}

TEST(LightPower, ExposureAndTemperatureKeepTheirMeaning) {
    EXPECT_NEAR(candela(point(R"("intensity": 10, "exposure": 2.5)")), 10 * std::exp2(2.5), 1e-3);
    const LightSource warm = scene_with(point(R"("intensity": 10, "temperature": 2700)")).lights[0];
    EXPECT_NEAR(luminance(intensity_of(warm, 0)), 10, 1e-4);
    EXPECT_GT(intensity_of(warm, 0).x, 2 * intensity_of(warm, 0).z);
    const LightSource plain = scene_with(point(R"("intensity": 3, "color": [0.1, 0.7, 0.3])")).lights[0];
    EXPECT_EQ(intensity_of(plain, 0), plain.color.at(0) * 3.0f);
}

TEST(LightPower, WhatDoesNotFitIsRefused) {
    EXPECT_NE(refusal(point(R"("intensity": 5, "unit": "lux")")).find("candela, lumen or watt"), std::string::npos);
    EXPECT_NE(refusal(R"({"type": "sun", "direction": [0,-1,0], "intensity": 5, "unit": "lumen"})").find("lux or watt"),
              std::string::npos);
    EXPECT_NE(refusal(point(R"("intensity": 5, "unit": "watt")")).find("efficacy"), std::string::npos);
    EXPECT_NE(refusal(point(R"("intensity": 5, "efficacy": 3)")).find("watts only"), std::string::npos);
    EXPECT_NE(refusal(point(R"("intensity": 5, "spread": "sphere", "unit": "lumen")")).find("for spots only"),
              std::string::npos);
    EXPECT_NE(refusal(spot(R"("intensity": 5, "spread": "sphere")")).find("lumens or watts"), std::string::npos);
    EXPECT_NE(refusal(point(R"("intensity": 5, "temperature": 20)")).find("temperature"), std::string::npos);
    EXPECT_NE(refusal(point(R"("intensity": 5, "up": [0,1,0])")).find("profile or a gobo"), std::string::npos);
    EXPECT_NE(refusal(point(R"("intensity": 5, "gobo": {"image": "a.png"})")).find("spots"), std::string::npos);
}

class WithFiles : public testing::Test {
protected:
    TempFolder scratch;
    Scene load(const std::string& light) {
        return load_scene_text("{\"tyndall\": 1, \"lights\": [" + light + "]}", scratch / "scene.json");
    }
};

TEST_F(WithFiles, AProfileBringsItsOwnCandela) {
    write_file_atomically(scratch / "half.ies", "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n50 50\n");
    const auto one = [&](const std::string& more) {
        return load(point(R"("ies": {"file": "half.ies")" + more)).lights[0];
    };
    EXPECT_FLOAT_EQ(candela_of(one("}"), 0), 50);
    EXPECT_FLOAT_EQ(candela_of(one(R"(, "multiplier": 3})"), 0), 150);
    EXPECT_FLOAT_EQ(candela_of(one(R"(}, "exposure": 1)"), 0), 100);
    EXPECT_FLOAT_EQ(candela_of(one(R"(}, "intensity": 8)"), 0), 8);
    // Half of the sphere shines: 2π candela per lumen.
    EXPECT_NEAR(candela_of(one(R"(}, "intensity": 800, "unit": "lumen")"), 0), 800 / (sphere / 2), 1e-3);
    EXPECT_NE(error_message(ExitCode::refused, [&] { one(R"(, "multiplier": 3}, "intensity": 8)"); })
                  .find("cannot be combined"),
              std::string::npos);
    write_file_atomically(scratch / "bad.ies", "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n50\n");
    EXPECT_NE(error_message(ExitCode::refused, [&] { load(point(R"("ies": {"file": "bad.ies"})")); }).find("bad.ies"),
              std::string::npos);
    EXPECT_EQ(error_of([&] { load(point(R"("ies": {"file": "none.ies"})")); }).code, ExitCode::unreadable);
}
}
}
