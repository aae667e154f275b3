// The stability suite, case by case, and that its judgment is sound.
#include "measure/stress/stress.h"
#include "modes/mode.h"
#include "modes/shared_limitations.h"
#include "trace/view.h"

#include "base/error.h"
#include "base/random.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace tyndall::test {
namespace {
std::vector<std::string> case_names() {
    std::vector<std::string> names;
    for (const StressCase& stress : stress_cases()) names.emplace_back(stress.id);
    return names;
}

const StressCase& case_named(std::string_view id) { return *std::ranges::find(stress_cases(), id, &StressCase::id); }

// A case is run once for all tests of this process.
const std::vector<StressResult>& results_of(std::string_view id) {
    static std::map<std::string_view, std::vector<StressResult>> known;
    const StressCase& stress = case_named(id);
    const auto [place, fresh] = known.try_emplace(stress.id);
    if (fresh) place->second = run_stress(stress, modes());
    return place->second;
}

class Stability : public testing::TestWithParam<std::string> {};

TEST_P(Stability, NoModeFailsInSilence) {
    for (const StressResult& result : results_of(GetParam()))
        for (const StressPoint& point : result.points)
            EXPECT_FALSE(point.silent()) << result.mode << ", " << result.stress->sweep << " " << point.value
                                         << ": error " << point.error << ", allowed " << point.allowed << "; "
                                         << point.non_finite << " not finite, " << point.negative << " negative";
}

std::string test_name(const testing::TestParamInfo<std::string>& parameter) {
    std::string name = parameter.param;
    std::ranges::replace(name, '-', '_');
    return name;
}
INSTANTIATE_TEST_SUITE_P(Cases, Stability, testing::ValuesIn(case_names()), test_name);

TEST(StressCases, AreManyAndWellFormed) {
    EXPECT_GE(stress_cases().size(), 180u);
    std::set<std::string_view> ids;
    for (const StressCase& stress : stress_cases()) {
        EXPECT_TRUE(ids.insert(stress.id).second) << stress.id;
        EXPECT_FALSE(stress.values.empty()) << stress.id;
        EXPECT_TRUE(stress.scene || (stress.measure.error && stress.modes.program())) << stress.id;
        const auto takes = [&](const Mode& mode) { return takes_part(stress, mode); };
        EXPECT_NE(std::ranges::any_of(modes(), takes), stress.modes.program()) << stress.id;
    }
}

// --- the judgment ---------------------------------------------------------------------------------------------------
StressPoint point_of(double value, double error, double excused_up_to = -1) {
    StressPoint point;
    point.value = value, point.error = error, point.allowed = 0.1, point.excused_up_to = excused_up_to;
    return point;
}

TEST(StressVerdict, HoldsDegradesOrFails) {
    StressResult result;
    result.points = {point_of(1, 0.05), point_of(2, 0.1, 0.3)};
    EXPECT_EQ(result.verdict(), Verdict::holds);
    EXPECT_EQ(result.first(), nullptr);
    result.points.push_back(point_of(3, 0.2, 0.3));
    EXPECT_EQ(result.verdict(), Verdict::degrades);
    EXPECT_EQ(result.first()->value, 3);
    result.points.push_back(point_of(4, 0.11));
    EXPECT_EQ(result.verdict(), Verdict::fails);
    EXPECT_EQ(result.first()->value, 4);
}

TEST(StressVerdict, ADegradedModeIsExcusedUpToSomeError) {
    StressResult result;
    result.points = {point_of(1, 0.3, 0.3)};
    EXPECT_EQ(result.verdict(), Verdict::degrades);
    result.points.push_back(point_of(2, 0.31, 0.3));
    EXPECT_EQ(result.verdict(), Verdict::fails);
    result.points.back().excused_up_to = infinity;
    EXPECT_EQ(result.verdict(), Verdict::degrades);
}

TEST(StressVerdict, ALimitationWrongExcusesMoreThanOneDegraded) {
    Mode black = find_mode("march");
    black.prepare = [](const View&, const Snapshot&, const Settings&, History*) {
        return ScatterFunction(
            [](const RayBatch&, std::span<Scatter> results) { std::ranges::fill(results, Scatter{}); });
    };
    black.limitations = [](const View&, const Snapshot&, const Settings&) {
        return Limitations{{Severity::degraded, &limitation::deep_steps, Subject::medium}};
    };
    EXPECT_EQ(run_stress(case_named("slab"), {&black, 1})[0].verdict(), Verdict::fails);
    black.limitations = [](const View&, const Snapshot&, const Settings&) {
        return Limitations{{Severity::wrong, &limitation::deep_steps, Subject::medium}};
    };
    EXPECT_EQ(run_stress(case_named("slab"), {&black, 1})[0].verdict(), Verdict::degrades);
}

TEST(StressVerdict, NothingExcusesWhatIsNoLight) {
    StressResult result;
    result.points = {point_of(1, 0, infinity)};
    result.points[0].negative = 1;
    EXPECT_EQ(result.verdict(), Verdict::fails);
    result.points[0].negative = 0, result.points[0].non_finite = 1;
    EXPECT_EQ(result.verdict(), Verdict::fails);
}

TEST(StressVerdict, CountsWarningsThatNothingBearsOut) {
    StressResult result;
    for (const double measured : {0.01, 0.049, 0.051, 3.0}) {
        StressPoint point = point_of(1, 0, infinity);
        point.wrong = true, point.measured = measured;
        result.points.push_back(point);
    }
    result.points.push_back(point_of(1, 0, infinity));
    const WrongWarnings warnings = wrong_warnings({&result, 1});
    EXPECT_EQ(warnings.count, 4);
    EXPECT_EQ(warnings.idle, 2);
}

TEST(StressRun, StopsWhenCancelled) {
    std::atomic<bool> cancel = true;
    EXPECT_THROW(run_stress(case_named("thin-fog"), modes(), &cancel), Error);
}

// A mode that always warns would never fail; the suite counts that too.
TEST(StabilityOfWarnings, OfTenWrongOnesNineAreBorneOut) {
    WrongWarnings all;
    for (const StressCase& stress : stress_cases())
        for (const StressResult& result : results_of(stress.id)) {
            if (result.mode == "path") continue; // never says wrong of what it promises
            const WrongWarnings warnings = wrong_warnings({&result, 1});
            all.count += warnings.count, all.idle += warnings.idle;
        }
    EXPECT_GT(all.count, 0);
    EXPECT_LE(all.idle, 0.1 * all.count);
}
}
}
