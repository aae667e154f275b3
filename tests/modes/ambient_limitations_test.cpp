// How much ambient light surfaces and fog would block, against closed forms.
#include "modes/ambient_limitations.h"

#include "modes/mode.h"
#include "modes/settings.h"
#include "support/limitations.h"
#include "support/tiny_scenes.h"
#include "trace/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tyndall::test {
namespace {
const Box unit_box{vec3(0), vec3(1)};

View view_of(vec3 eye, vec3 up) {
    View view;
    view.camera = look_at(eye, vec3(0.5f), up, 0.1f);
    view.size = {64, 36};
    return view;
}

Mesh wide_roof() { return quad({-1e4f, 1.01f, -1e4f}, {2e4f, 0, 0}, {0, 0, 2e4f}); }

// The standard error of 32 points with 16 stratified directions each is about 1 %.
TEST(AmbientLimitations, ARoofOverThinFogBlocksHalf) {
    const TestScene scene = make_scene({homogeneous_medium(1e-4f, unit_box)}, {}, {wide_roof()}, vec3(1));
    EXPECT_NEAR(blocked_ambient(view_of({0.5f, 0.5f, 9}, {0, 1, 0}), scene.snapshot), 0.5, 0.05);
}

TEST(AmbientLimitations, ThinFogInTheOpenBlocksNothing) {
    const TestScene scene = make_scene({homogeneous_medium(1e-4f, unit_box)}, {}, {}, vec3(1));
    EXPECT_NEAR(blocked_ambient(view_of({0.5f, 0.5f, 9}, {0, 1, 0}), scene.snapshot), 0, 1e-3);
}

TEST(AmbientLimitations, UnboundedFogBlocksAll) {
    const TestScene scene = make_scene({homogeneous_medium(0.1f)}, {}, {}, vec3(1));
    EXPECT_EQ(blocked_ambient(view_of({0.5f, 0.5f, 9}, {0, 1, 0}), scene.snapshot), 1);
}

double e2(double x) { return std::exp(-x) + x * std::expint(-x); } // exponential integral

// Looking up: all that is seen has optical depth x to the eye, E2(depth - x) / 2 above it, and opaque fog below.
TEST(AmbientLimitations, HeightFogOpensUpwards) {
    constexpr double depth = 0.5;
    double open = 0, all = 0;
    for (int i = 0; i < 1000; ++i) {
        const double x = depth * (i + 0.5) / 1000;
        open += std::exp(-x) * e2(depth - x) / 2, all += std::exp(-x);
    }
    Medium fog = homogeneous_medium(static_cast<float>(depth / 20));
    fog.density.kind = DensityKind::height;
    fog.density.height_base = 0, fog.density.height_falloff = 20;
    const TestScene scene = make_scene({fog}, {}, {}, vec3(1));
    EXPECT_NEAR(blocked_ambient(view_of({0.5f, 0, 0.5f}, {0, 0, 1}), scene.snapshot), 1 - open / all, 0.03);
}

// A wide slab seen from above: (E2(x) + E2(y)) / 2 passes at optical depths x below the top and y above the bottom.
TEST(AmbientLimitations, ASlabOfFogBlocksByExponentialIntegrals) {
    constexpr double depth = 0.5;
    double open = 0, all = 0;
    for (int i = 0; i < 1000; ++i) {
        const double x = depth * (i + 0.5) / 1000;
        open += std::exp(-x) * (e2(x) + e2(depth - x)) / 2, all += std::exp(-x);
    }
    const TestScene scene =
        make_scene({homogeneous_medium(depth, {{-1e4f, 0, -1e4f}, {1e4f, 1, 1e4f}})}, {}, {}, vec3(1));
    EXPECT_NEAR(blocked_ambient(view_of({0.5f, 9, 0.5f}, {0, 0, 1}), scene.snapshot), 1 - open / all, 0.02);
}

TEST(AmbientLimitations, AllButPathReportIt) {
    const TestScene scene = make_scene({homogeneous_medium(1e-4f, unit_box)}, {}, {wide_roof()}, vec3(1));
    for (const char* name : {"march", "froxel", "shadow-map", "shadow-volume", "cone", "path"}) {
        const Limitations said =
            find_mode(name).limitations(view_of({0.5f, 0.5f, 9}, {0, 1, 0}), scene.snapshot, Settings{});
        const auto found =
            std::ranges::find_if(said, [](const Limitation& one) { return one.is(limitation::unshadowed_ambient); });
        ASSERT_EQ(found != said.end(), std::string_view(name) != "path") << name;
        if (found != said.end()) {
            EXPECT_NEAR(found->amounts[0], 50, 5) << name;
        }
    }
}
}
}
