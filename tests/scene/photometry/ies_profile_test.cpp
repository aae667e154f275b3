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
}
}
