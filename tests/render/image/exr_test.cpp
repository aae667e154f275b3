#include "base/random.h"
#include "render/image/exr.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <csignal>

namespace tyndall::test {
namespace {
// Layers whose values are all different and exact as half floats, with two lights.
Layers patterned(ivec2 size, ivec2 low, ivec2 display) {
    Layers layers;
    layers.display = display, layers.low = low, layers.size = size;
    layers.color = layers.inscatter = Image<vec3>(size);
    layers.alpha = layers.depth = layers.transmittance = layers.validity = Image<float>(size);
    for (size_t i = 0; i < layers.color.pixels.size(); ++i) {
        const float n = static_cast<float>(i % 512);
        layers.color.pixels[i] = vec3(n, n / 8, -n);
        layers.inscatter.pixels[i] = vec3(n / 4, n / 16, n * 2);
        layers.alpha.pixels[i] = n / 512, layers.transmittance.pixels[i] = 1 - n / 1024;
        layers.validity.pixels[i] = static_cast<float>(i % 2);
        layers.depth.pixels[i] = i % 7 == 0 ? infinity : 0.1f * n;
    }
    layers.lights = {{"sun", layers.inscatter}, {"lamp", layers.color}};
    return layers;
}

const ExrOptions all_layers{{"Z", "inscatter", "transmittance", "validity", "lights"}, false};

void expect_channel(const ExrFile& exr, const std::string& name, const float* first, size_t stride) {
    const Image<float>* channel = exr.channel(name);
    ASSERT_NE(channel, nullptr) << name;
    for (size_t i = 0; i < channel->pixels.size(); ++i) {
        const float value = first[i * stride], expected = std::isinf(value) ? no_surface_z : value;
        ASSERT_EQ(channel->pixels[i], expected) << name << " " << i;
    }
}

void expect_color(const ExrFile& exr, const std::string& layer, const Image<vec3>& image) {
    for (int c = 0; c < 3; ++c) expect_channel(exr, layer + "RGB"[c], &image.pixels[0].x + c, 3);
}
}

TEST(Exr, ReadsBackWhatWasWritten) {
    const TempFolder directory;
    const Layers layers = patterned({37, 29}, {5, 3}, {64, 40});
    write_exr(directory.file("a.exr"), layers, {}, all_layers);
    const ExrFile exr = read_exr(directory.file("a.exr"));
    EXPECT_EQ(exr.display, layers.display);
    EXPECT_EQ(exr.low, layers.low);
    EXPECT_EQ(exr.size, layers.size);
    EXPECT_EQ(exr.compression, "zip");
    EXPECT_EQ(exr.channels.size(), 16u);
    expect_color(exr, "", layers.color);
    expect_color(exr, "inscatter.", layers.inscatter);
    expect_color(exr, "light_sun.", layers.inscatter);
    expect_color(exr, "light_lamp.", layers.color);
    expect_channel(exr, "A", layers.alpha.pixels.data(), 1);
    expect_channel(exr, "Z", layers.depth.pixels.data(), 1);
    expect_channel(exr, "transmittance.T", layers.transmittance.pixels.data(), 1);
    expect_channel(exr, "validity.T", layers.validity.pixels.data(), 1);
    EXPECT_EQ(exr.channel("nothing"), nullptr);
    EXPECT_EQ(directory.names(), std::vector<std::string>{"a.exr"});
}

TEST(Exr, WritesOnlyTheLayersAskedFor) {
    const TempFolder directory;
    const Layers layers = patterned({4, 4}, {0, 0}, {4, 4});
    write_exr(directory.file("a.exr"), layers, {}, {{}, false});
    EXPECT_EQ(read_exr(directory.file("a.exr")).channels.size(), 4u);
    const std::string text = error_message(ExitCode::usage, [&] {
        write_exr(directory.file("b.exr"), layers, {}, {{"Z", "deph"}, false});
    });
    EXPECT_NE(text.find("deph"), text.npos);
    EXPECT_EQ(directory.names(), std::vector<std::string>{"a.exr"});
}

TEST(Exr, NamesItsChannelsBeforehand) {
    const TempFolder directory;
    Layers layers = patterned({4, 4}, {0, 0}, {4, 4});
    layers.lights = {{"Key light", layers.color},
                     {"Key_light", layers.color},
                     {"lampe de chevet trés trés longue", layers.color},
                     {"lampe de chevet trés trés longue aussi", layers.color},
                     {"", layers.color}};
    write_exr(directory.file("a.exr"), layers, {}, all_layers);
    std::vector<std::string> names, lights;
    for (const auto& channel : read_exr(directory.file("a.exr")).channels) names.push_back(channel.first);
    for (const auto& light : layers.lights) lights.push_back(light.first);
    lights.push_back("Key light"); // lights of one name share a layer
    EXPECT_EQ(names, channel_names(lights, false, all_layers));
    EXPECT_EQ(names.size(), 10u + 5 * 3);
    for (const std::string& name : names) {
        EXPECT_LE(name.size(), 31u);
        EXPECT_EQ(name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_."),
                  name.npos);
    }
    EXPECT_EQ(std::ranges::count(names, "light_Key_light_2.R"), 1);
}

TEST(Exr, ClampsAndCountsWhatHalfCannotHold) {
    const TempFolder directory;
    Layers layers = patterned({4, 4}, {0, 0}, {4, 4});
    layers.color.at(1, 2) = vec3(1e6f, -1e6f, 65504);
    write_exr(directory.file("half.exr"), layers, {}, {});
    const ExrFile half_file = read_exr(directory.file("half.exr"));
    EXPECT_EQ(half_file.channel("R")->at(1, 2), 65504);
    EXPECT_EQ(half_file.channel("G")->at(1, 2), -65504);
    EXPECT_EQ(half_file.attributes.at("tyndall:clamped"), "2");

    layers.color.at(0, 0) = vec3(0.1f, 1e-9f, 1e9f);
    write_exr(directory.file("float.exr"), layers, {}, {{}, true});
    const ExrFile float_file = read_exr(directory.file("float.exr"));
    expect_color(float_file, "", layers.color);
    EXPECT_EQ(float_file.attributes.at("tyndall:clamped"), "0");
}

TEST(Exr, StoredColorIsWhatTheFileHolds) {
    const TempFolder directory;
    Layers layers = patterned({16, 16}, {0, 0}, {16, 16});
    for (size_t i = 0; i < layers.color.pixels.size(); ++i)
        layers.color.pixels[i] = vec3(to_unit(hash(i)), 1e6f * to_unit(hash(i, 1u)), 1e-6f * to_unit(hash(i, 2u)));
    write_exr(directory.file("a.exr"), layers, {}, {});
    expect_color(read_exr(directory.file("a.exr")), "", stored_color(layers, {}));
}

TEST(Exr, SameInputGivesSameBytes) {
    const TempFolder directory;
    const Layers layers = patterned({100, 70}, {0, 0}, {100, 70});
    Provenance provenance;
    provenance.attributes["tyndall:mode"] = "march";
    write_exr(directory.file("a.exr"), layers, provenance, all_layers);
    write_exr(directory.file("b.exr"), layers, provenance, all_layers);
    EXPECT_EQ(bytes_of(directory.file("a.exr")), bytes_of(directory.file("b.exr")));
}

TEST(Exr, RefusesAFileCutAnywhere) {
    const TempFolder directory;
    write_exr(directory.file("a.exr"), patterned({61, 40}, {0, 0}, {61, 40}), {}, all_layers);
    const std::string bytes = bytes_of(directory.file("a.exr"));
    for (size_t k = 0; k < 300; ++k) {
        const size_t length = k < 20 ? bytes.size() - 1 - k : bytes.size() * (k - 20) / 280;
        directory.put("cut.exr", std::string_view(bytes).substr(0, length));
        const std::string text = error_message(ExitCode::refused, [&] { read_exr(directory.file("cut.exr")); });
        EXPECT_NE(text.find("cut.exr"), text.npos) << text;
    }
}

TEST(Exr, NeverTakesDamageForAPictureOfOtherShape) {
    const TempFolder directory;
    write_exr(directory.file("a.exr"), patterned({61, 40}, {0, 0}, {61, 40}), {}, all_layers);
    const std::string bytes = bytes_of(directory.file("a.exr"));
    int refused = 0;
    for (uint32_t k = 0; k < 400; ++k) {
        std::string damaged = bytes;
        const size_t where = k < 200 ? k * 6 % 1500 : hash(k) % bytes.size();
        damaged[where] = static_cast<char>(damaged[where] ^ (1 << hash(k, 1u) % 8));
        directory.put("flip.exr", damaged);
        const Error error = error_of([&] { read_exr(directory.file("flip.exr")); });
        EXPECT_TRUE(error.code == ExitCode::ok || error.code == ExitCode::refused) << error.what();
        EXPECT_LE(std::string(error.what()).size(), 500u);
        refused += error.code == ExitCode::refused;
    }
    EXPECT_GT(refused, 200); // compressed pixels carry a checksum
}

TEST(Exr, LeavesNothingOnAFullDisk) {
    const TempFolder directory;
    const Layers layers = patterned({200, 150}, {0, 0}, {200, 150});
    write_exr(directory.file("old.exr"), layers, {}, {});
    const std::string old = bytes_of(directory.file("old.exr"));

    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    for (const rlim_t most : {0u, 1u, 4095u, 4096u, static_cast<unsigned>(old.size() - 1)}) {
        const rlimit small{most, limit.rlim_max};
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
        error_message(ExitCode::unwritable, [&] { write_exr(directory.file("new.exr"), layers, {}, {}); });
        error_message(ExitCode::unwritable, [&] { write_exr(directory.file("old.exr"), layers, {}, all_layers); });
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    }
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(directory.names(), std::vector<std::string>{"old.exr"});
    EXPECT_EQ(bytes_of(directory.file("old.exr")), old);
}
}
