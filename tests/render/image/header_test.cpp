// What the header says about camera, time and color.
#include "render/image/exr.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

#include <sstream>

namespace tyndall::test {
namespace {
std::map<std::string, std::string> attributes_of(const Provenance& provenance, ivec2 display = {8, 4}) {
    const TempFolder directory;
    Layers layers;
    layers.display = display, layers.size = {2, 2}, layers.low = {1, 1};
    layers.color = layers.inscatter = Image<vec3>(layers.size);
    layers.alpha = layers.depth = layers.transmittance = layers.validity = Image<float>(layers.size);
    write_exr(directory.file("a.exr"), layers, provenance, {});
    return read_exr(directory.file("a.exr")).attributes;
}

// Row vector times the matrix of an attribute, divided by w.
dvec3 transformed(const std::string& matrix, vec3 point) {
    std::istringstream text(matrix);
    double m[4][4], result[4];
    for (auto& row : m)
        for (double& value : row) text >> value;
    EXPECT_FALSE(text.fail()) << matrix;
    for (int c = 0; c < 4; ++c) result[c] = point.x * m[0][c] + point.y * m[1][c] + point.z * m[2][c] + m[3][c];
    return dvec3(result[0], result[1], result[2]) / result[3];
}
}

TEST(ExrHeader, ProjectsTheWorldToThePicture) {
    const ivec2 display(640, 360);
    Provenance provenance;
    for (const float ortho : {0.0f, 3.0f}) {
        provenance.camera = look_at({3, 2, 7}, {-1, 0.5f, 1}, {0.1f, 1, 0}, 0.9f);
        provenance.camera.ortho_height = ortho;
        const auto attributes = attributes_of(provenance, display);
        for (const vec2 pixel : {vec2(0, 0), vec2(640, 360), vec2(320, 180), vec2(17, 300), vec2(600, 3.5f)})
            for (const float t : {0.5f, 3.0f, 40.0f}) {
                const Ray ray = camera_ray(provenance.camera, display, pixel);
                const dvec3 ndc = transformed(attributes.at("worldToNDC"), ray.at(t));
                EXPECT_NEAR(ndc.x, pixel.x / 640, 1e-5) << ortho << " " << t;
                EXPECT_NEAR(ndc.y, pixel.y / 360, 1e-5) << ortho << " " << t;

                // Camera space: x right, y up, z forward, so z is the depth.
                const dvec3 inside = transformed(attributes.at("worldToCamera"), ray.at(t));
                EXPECT_NEAR(inside.z, planar_depth(provenance.camera, ray, t), 1e-4);
                EXPECT_EQ(inside.x > 1e-4, pixel.x > 320) << pixel.x;
                EXPECT_EQ(inside.y > 1e-4, pixel.y < 180) << pixel.y;
            }
    }
}

TEST(ExrHeader, TellsTheFieldOfView) {
    Provenance provenance;
    provenance.camera.vertical_fov = 2 * std::atan(0.5f);
    EXPECT_FLOAT_EQ(std::stof(attributes_of(provenance).at("screenWindowWidth")), 2);
    provenance.camera.ortho_height = 3;
    EXPECT_FLOAT_EQ(std::stof(attributes_of(provenance).at("screenWindowWidth")), 6);
}

TEST(ExrHeader, TellsColorAndSoftware) {
    const auto attributes = attributes_of({});
    EXPECT_EQ(attributes.at("colorInteropID"), "lin_rec709_scene");
    EXPECT_EQ(attributes.at("chromaticities").substr(0, 15), "0.639999986 0.3");
    EXPECT_EQ(attributes.at("software").substr(0, 8), "Tyndall ");
    for (const char* absent : {"capDate", "utcOffset", "owner", "hostname"}) EXPECT_FALSE(attributes.contains(absent));
}

TEST(ExrHeader, TellsFrameAndTime) {
    const auto at = [](int frame, double rate) {
        Provenance provenance;
        provenance.frame = frame, provenance.frame_rate = rate;
        return attributes_of(provenance);
    };
    const auto film = at(24 * 3661 + 7, 24);
    EXPECT_EQ(film.at("framesPerSecond"), "24/1");
    EXPECT_EQ(film.at("timeCode"), "01:01:01:07");
    EXPECT_EQ(film.at("imageCounter"), std::to_string(24 * 3661 + 7));
    EXPECT_EQ(at(0, 24).at("timeCode"), "00:00:00:00");
    EXPECT_EQ(at(29, 30).at("timeCode"), "00:00:00:29");
    EXPECT_EQ(at(-1, 25).at("timeCode"), "23:59:59:24");
    EXPECT_EQ(at(-1, 25).at("imageCounter"), "-1");
    EXPECT_EQ(at(1, 24000.0 / 1001).at("framesPerSecond"), "24000/1001");
    EXPECT_EQ(at(1, 23.976).at("framesPerSecond"), "24000/1001");
    EXPECT_FALSE(at(1, 60).contains("timeCode"));
    EXPECT_EQ(at(1, 60).at("framesPerSecond"), "60/1");
}

TEST(ExrHeader, KeepsTextsAsTheyAre) {
    Provenance provenance;
    provenance.attributes["tyndall:mode"] = "march";
    provenance.attributes["tyndall:limits"] = std::string(3000, 'x') + "\nünïcode \"quoted\"";
    const auto attributes = attributes_of(provenance);
    for (const auto& [name, text] : provenance.attributes) EXPECT_EQ(attributes.at(name), text);
    EXPECT_EQ(attributes.at("dataWindow"), "1 1 2 2");
    EXPECT_EQ(attributes.at("displayWindow"), "0 0 7 3");
}
}
