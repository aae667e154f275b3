// The proof of a scene, on the scenes that come with the program.
#include "measure/verify/verify.h"
#include "scene/scene.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
void expect_proof(const std::string& name, const VerifyOptions& options) {
    const Scene scene = load_scene(std::string(TYNDALL_SOURCE_DIR) + "/scenes/" + name + ".json");
    const std::vector<Check> checks = verify_scene(scene, options, {});
    EXPECT_GE(checks.size(), 5u) << name;
    for (const Check& check : checks)
        EXPECT_TRUE(check.holds()) << name << ", " << check.topic << ": " << check.name << " is " << check.measured;
}

class ExampleScene : public testing::TestWithParam<const char*> {};
TEST_P(ExampleScene, HoldsUnderProof) {
    VerifyOptions options;
    options.size = {48, 27}, options.samples = 64;
    expect_proof(GetParam(), options);
}
INSTANTIATE_TEST_SUITE_P(Verify, ExampleScene, testing::Values("window", "spotlight", "cloud"));

class EveryScene : public testing::TestWithParam<const char*> {};
TEST_P(EveryScene, NightlyHoldsUnderProof) { expect_proof(GetParam(), {}); }
INSTANTIATE_TEST_SUITE_P(Verify, EveryScene,
                         testing::Values("window", "spotlight", "pillars", "lantern", "cloud", "campfire",
                                         "forest_morning", "concert", "cumulus_sky"));
}
}
