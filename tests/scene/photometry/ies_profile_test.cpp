// Tables of IES files against the files themselves.
#include "base/io/file.h"
#include "base/random.h"
#include "scene/photometry/ies_file.h"
#include "scene/photometry/ies_profile.h"
#include "support/corpus.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
dvec3 random_direction(uint32_t i) {
    const double z = 1 - 2 * double{to_unit(hash(i, 1u))}, turn = 2 * double{pi} * double{to_unit(hash(i, 2u))};
    const double across = std::sqrt(1 - z * z);
    return {across * std::cos(turn), across * std::sin(turn), z};
}

TEST(IesProfile, AgreesWithItsFileInEveryDirection) {
    for (const auto& path : test::corpus_files("ies", {".ies", ".IES"})) {
        const IesFile file = read_ies(read_file(path), path.string());
        const auto profile = make_ies_profile(file, "");
        // Files of type B are resampled.
        const double tolerance = file.type == Photometry::type_c ? 2e-5 : 0.02;
        double sum = 0;
        constexpr uint32_t count = 20000;
        for (uint32_t i = 0; i < count; ++i) {
            const dvec3 direction = random_direction(i);
            const double share = profile_factor(*profile, direction);
            ASSERT_NEAR(share, candela_at(file, direction) / file.peak(), tolerance) << path << " " << i;
            if (std::acos(direction.z) > profile->reach + 1e-5) {
                ASSERT_EQ(share, 0) << path;
            }
            sum += share;
        }
        EXPECT_NEAR(sum / count * 4 * double{pi} * profile->peak / profile->lumens, 1, 0.5)
            << path; // narrow ones are hit some 40 times
        EXPECT_LT(profile->shares.size(), 1000000u) << path;
    }
}

TEST(IesProfile, UnevenAnglesGetAFineTable) {
    const std::string text = "TILT=NONE\n1 -1 1 4 3 1 2 0 0 0\n1 1 0\n0 7.13 33.3 90\n0 41.7 90\n"
                             "100 90 50 0\n100 80 40 0\n100 70 30 0\n";
    const IesFile file = read_ies(text, "a.ies");
    const auto profile = make_ies_profile(file, "");
    for (uint32_t i = 0; i < 5000; ++i) {
        const dvec3 direction = random_direction(i);
        ASSERT_NEAR(profile_factor(*profile, direction), candela_at(file, direction) / file.peak(), 1e-3);
    }
    EXPECT_NEAR(profile->reach, 0.5f * pi, 1e-5f);
}

// Lumens of a table, from means over thin rings about the aim up to some angle.
double lumens_of(const IesProfile& profile, double last_degrees) {
    constexpr int rings = 4000, around = 360;
    const double step = glm::radians(last_degrees) / rings;
    double sum = 0;
    for (int ring = 0; ring < rings; ++ring)
        for (int k = 0; k < around; ++k) {
            const double v = (ring + 0.5) * step, h = glm::radians(k + 0.5);
            const dvec3 direction(std::sin(v) * std::cos(h), std::sin(v) * std::sin(h), std::cos(v));
            sum += profile_factor(profile, direction) * std::sin(v);
        }
    return sum * step * 2 * double{pi} / around * profile.peak;
}

TEST(IesProfile, FineAnglesKeepTheirLumensAndPeak) {
    // A laser in steps of 0.02 degrees, and beams of types B and A in steps of 0.1.
    std::string angles, values;
    for (int i = 0; i < 100; ++i)
        angles += std::to_string(0.02 * i) + " ", values += std::to_string(1e6 * std::exp(-0.22 * i * i)) + " ";
    std::vector<std::string> files = {"TILT=NONE\n1 -1 1 101 1 1 2 0 0 0\n1 1 0\n" + angles + " 90\n0\n" + values +
                                      " 0\n"};
    for (const char* type : {"2", "3"}) {
        std::string steps, beam;
        for (int h = -20; h <= 20; ++h) {
            steps += std::to_string(0.1 * h) + " ";
            for (int v = -20; v <= 20; ++v) beam += std::to_string(1e6 * std::exp(-0.13 * (v * v + h * h))) + " ";
        }
        files.push_back("TILT=NONE\n1 -1 1 41 41 " + std::string(type) + " 2 0 0 0\n1 1 0\n" + steps + "\n" + steps +
                        "\n" + beam);
    }
    for (const std::string& text : files) {
        const IesFile file = read_ies(text, "a.ies");
        const auto profile = make_ies_profile(file, "");
        EXPECT_NEAR(profile->peak / file.peak(), 1, 0.01);
        EXPECT_DOUBLE_EQ(profile->lumens, zonal_lumens(file));
        EXPECT_NEAR(lumens_of(*profile, 3) / profile->lumens, 1, 1e-3);
        EXPECT_EQ(profile->loss, "");
        EXPECT_LT(profile->shares.size(), 300000u);
    }
}

TEST(IesProfile, SaysWhatATableTooCoarseLoses) {
    const auto loss = [](const char* candela) {
        const std::string text = "TILT=NONE\n1 -1 1 5 1 1 2 0 0 0\n1 1 0\n0 20 20.0002 20.0004 90\n0\n";
        const IesFile file = read_ies(text + candela, "a.ies");
        const auto profile = make_ies_profile(file, "");
        if (profile->peak > 0) {
            EXPECT_NEAR(lumens_of(*profile, 91) / zonal_lumens(file), 1, 1e-3);
        }
        return profile->loss;
    };
    EXPECT_EQ(loss("100 90 90 90 0\n"), "");
    EXPECT_NE(loss("0 0 100 0 0\n").find("black"), std::string::npos);
    EXPECT_NE(loss("1 1 100 1 1\n").find("the peak of 100 candela becomes 1"), std::string::npos);
}
}
}
