// What a chart says about pictures whose errors are known.
#include "base/json/json.h"
#include "base/random.h"
#include "measure/chart/report.h"
#include "modes/mode.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace tyndall::test {
namespace {
const ivec2 size(128, 96);
constexpr double pixels = 128 * 96;

Image<vec3> flat(float value) { return Image<vec3>(size, vec3(value)); }

// Gray noise of its own for each seed, evenly spread over ± amplitude: variance amplitude² / 3.
Image<vec3> noisy(float value, float amplitude, uint32_t seed) {
    Image<vec3> image = flat(value);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] += amplitude * (2 * random_unit(static_cast<uint32_t>(i), 0, 0, seed) - 1);
    return image;
}

Reference exact_reference(float color, float inscatter) {
    Reference reference;
    reference.halves[0] = reference.halves[1] = {flat(color), flat(inscatter)};
    reference.unlit[0] = reference.unlit[1] = {flat(0), flat(0)};
    return reference;
}

ChartPoint point_at(const char* mode, double rung, double seconds, double error) {
    ChartPoint point;
    point.mode = mode, point.settings = "pixel.samples=1", point.rung = rung;
    point.frame_seconds = point.frame_fastest = point.frame_slowest = point.seconds_1 = point.seconds_100 = seconds;
    point.errors.error = point.errors.rmse = point.fog_error = error;
    return point;
}

Chart small_chart() {
    Chart chart;
    chart.size = chart.sequence_size = size;
    chart.job.render.scene_file = "a/scene.json";
    chart.modes = {{"march", "", Accuracy::single_scattering, {}}, {"billboard", "", Accuracy::artistic, {}}};
    chart.points = {point_at("march", 1, 0.01, 0.15), point_at("march", 2, 0.05, 0.04), point_at("march", 3, 0.2, 0.06),
                    point_at("billboard", 1, 0.002, 2)};
    chart.points[3].gain = 0.5, chart.points[3].fitted = chart.points[3].errors, chart.points[3].fitted.error = 0.9;
    chart.points[3].fitted_fog_error = 0.8;
    mark_best(chart.points);
    return chart;
}

TEST(ChartErrors, TakeTheWorseOfPictureAndFogLight) {
    const ReferenceMetrics reference_metrics = make_metrics(exact_reference(2, 0.5f), false);
    const ChartErrors errors = chart_errors(reference_metrics, {flat(2.2f), flat(0.6f)});
    EXPECT_NEAR(errors.rmse, 0.1, 1e-6);
    EXPECT_NEAR(errors.inscatter_rmse, 0.2, 1e-6);
    EXPECT_EQ(errors.error, errors.inscatter_rmse);
    EXPECT_NEAR(errors.bias, 0.1, 1e-6);
    EXPECT_NEAR(errors.inscatter_bias, 0.2, 1e-6);
    EXPECT_NEAR(errors.rel_mse, 0.01 / 1.01, 1e-6); // 0.2² / (2² + 0.01 · 2²)
    EXPECT_EQ(errors.uncertainty, 0);
}

TEST(ChartErrors, DoNotCountTheNoiseOfTheReference) {
    // An error of 0.1 under noise of 0.5 / √3 = 0.29 in either half. The product of the errors is 0.01 plus twice the
    // mean of the halves' noise times 0.1 (deviation 0.1 · 0.29 · √2) plus a product of both (0.29²), over all pixels.
    Reference reference = exact_reference(1, 1);
    for (uint32_t half = 0; half < 2; ++half) reference.halves[half].color = noisy(1, 0.5f, half + 1);
    const ChartErrors errors = chart_errors(make_metrics(reference, false), {flat(1.1f), flat(1)});
    const double variance = 0.25 / 3;
    const double deviation = std::sqrt((0.01 * 2 * variance + variance * variance) / pixels); // of the square
    EXPECT_NEAR(errors.rmse * errors.rmse, 0.01, 4 * deviation);
    EXPECT_NEAR(errors.uncertainty, std::sqrt(0.01 + deviation) - 0.1, 0.3 * deviation / 0.2);
}

TEST(ChartErrors, LeaveOutWhatLightsHaveNoPartIn) {
    Reference reference = exact_reference(3, 1);
    reference.unlit[0] = reference.unlit[1] = {flat(2), flat(0.25f)};
    const ReferenceMetrics reference_metrics = make_metrics(reference, true);
    const ChartErrors errors = chart_errors(reference_metrics, {flat(1), flat(0.75f)});
    EXPECT_EQ(errors.error, 0);
    EXPECT_LT(errors.flip, 1e-6); // of the whole picture
    EXPECT_EQ(whole(reference_metrics, flat(1)).pixels[0], vec3(3));
}

TEST(ChartErrors, FitOneGainToTheFogLight) {
    const ReferenceMetrics reference_metrics = make_metrics(exact_reference(1, 0.5f), false);
    const ColorLayers look{flat(2.5f), flat(2)}; // surfaces of 0.5, fog light four times too strong
    const double gain = fitted_gain(reference_metrics, look);
    EXPECT_NEAR(gain, 0.25, 1e-7);
    EXPECT_NEAR(chart_errors(reference_metrics, with_gain(look, gain)).error, 0, 1e-6);
    EXPECT_EQ(fitted_gain(reference_metrics, {flat(1), flat(0)}), 1);
}

TEST(ChartFlicker, CountsChangesThatTheReferenceLacks) {
    std::vector<ReferenceMetrics> frames;
    std::vector<ColorLayers> steady, flickering;
    for (int t = 0; t < 4; ++t) {
        const float now = 1 + 0.25f * static_cast<float>(t); // the scene itself grows brighter: mean 1.375
        frames.push_back(make_metrics(exact_reference(now, now), false));
        steady.push_back({flat(now + 0.5f), flat(now)});
        flickering.push_back({flat(now + (t % 2 ? 0.1f : 0)), flat(now)});
    }
    EXPECT_NEAR(chart_flicker(frames, steady), 0, 1e-6);
    EXPECT_NEAR(chart_flicker(frames, flickering), 0.1 / 1.375, 1e-6);
}

TEST(Chart, MarksWhatNothingBeats) {
    const Chart chart = small_chart();
    EXPECT_EQ(chart.points[0].best_1, 1);
    EXPECT_EQ(chart.points[1].best_1, 1);
    EXPECT_EQ(chart.points[2].best_1, 0); // rung 2 is quicker and better
    EXPECT_EQ(chart.points[3].best_1, 1); // nothing is as quick
}

TEST(Chart, AdvisesTheQuickestGoodEnoughAndTheBestInTime) {
    std::map<double, std::string> of_error, in_seconds;
    for (const Advice& advice : advice_of(small_chart()))
        (advice.error > 0 ? of_error[advice.error] : in_seconds[advice.seconds]) =
            advice.single ? point_name(*advice.single) : "none";
    EXPECT_EQ(of_error, (std::map<double, std::string>{
                            {0.2, "march.1"}, {0.1, "march.2"}, {0.05, "march.2"}, {0.02, "none"}, {0.01, "none"}}));
    EXPECT_EQ(in_seconds, (std::map<double, std::string>{{1.0 / 30, "march.1"}, {0.1, "march.2"}, {1.0, "march.2"}}));
}

TEST(Chart, AdvisesNothingThatIsMoreThanHalfWrong) {
    Chart chart = small_chart();
    chart.points = {point_at("march", 1, 0.5, 0.45), point_at("billboard", 1, 0.002, 0.94)};
    for (const Advice& advice : advice_of(chart))
        for (const auto& point : {advice.single, advice.sequence, advice.fog})
            EXPECT_TRUE(!point || point->mode == "march") << goal_text(advice);
}

TEST(Chart, ListsWhatWasLeftOutBesideTheAdvice) {
    Chart chart = small_chart();
    EXPECT_EQ(chart_text(chart).find("skipped"), std::string::npos);
    chart.modes.clear(); // their pictures are on the page
    chart.job.longest = 0.7, chart.threads = 2, chart.load_before = 6;
    chart.skipped = {{"march", "pixel.samples=64", 4, 1.25}, {"march", "pixel.samples=256", 5, 1.25}};
    const std::string text = chart_text(chart), page = chart_html(chart);
    for (const char* words :
         {"2 settings skipped: an image would take more than 700 ms (--longest); other processes were "
          "running (load 6.0 on 2 threads)",
          "march 4, 1.2 s or more: pixel.samples=64", "march 5, 1.2 s or more: pixel.samples=256"}) {
        EXPECT_NE(text.find(words), text.npos) << text;
        EXPECT_NE(page.find(words), page.npos) << page;
    }
}

TEST(Chart, SaysTheSameInCsvAndJson) {
    const Chart chart = small_chart();
    const Json json = parse_json(chart_json(chart), "chart.json");
    const std::vector<Json>& points = json.find("points")->items;
    ASSERT_EQ(points.size(), chart.points.size());
    EXPECT_EQ(points[1].number_or("error", 0), 0.04);
    EXPECT_EQ(points[1].find("gain")->kind, Json::Kind::null);
    EXPECT_EQ(points[3].number_or("fitted_error", 0), 0.9);
    const std::string csv = chart_csv(chart);
    EXPECT_EQ(std::ranges::count(csv, '\n'), 5);
    EXPECT_NE(csv.find("march,\"pixel.samples=1\",2,"), csv.npos);
}

TEST(Chart, DrawsEveryPointAndLooksTwice) {
    const std::string svg = chart_svg(small_chart(), FrameTime::single, ErrorOf::worse);
    for (const char* id : {"march.1", "march.2", "march.3", "billboard.1", "billboard.1.fitted"})
        EXPECT_NE(svg.find(std::string("data-id='") + id + "'"), svg.npos) << id;
    EXPECT_EQ(svg.find("nan"), svg.npos);
    EXPECT_EQ(svg.find("inf"), svg.npos);
}

// The numbers behind each `key='` in a drawing.
std::vector<double> numbers_of(const std::string& svg, const std::string& key) {
    std::vector<double> numbers;
    for (size_t at = svg.find(key); at != svg.npos; at = svg.find(key, at + 1))
        numbers.push_back(std::stod(svg.substr(at + key.size())));
    return numbers;
}

TEST(Chart, NamesMarksBelowThePlotAndKeepsWordsOffThem) {
    const std::string svg = chart_svg(small_chart(), FrameTime::single, ErrorOf::worse);
    for (const char* name : {">march<", ">billboard<", ">gain fitted<", ">unbeaten<"})
        EXPECT_NE(svg.find(name), svg.npos) << name;
    // Letters stand left of the plot or below it.
    const std::vector<double> x = numbers_of(svg, "<text x='");
    std::vector<double> y;
    for (size_t at = svg.find("<text x='"); at != svg.npos; at = svg.find("<text x='", at + 1))
        y.push_back(std::stod(svg.substr(svg.find("y='", at) + 3)));
    ASSERT_EQ(x.size(), y.size());
    for (size_t i = 0; i < x.size(); ++i) EXPECT_TRUE(x[i] < 78 || y[i] > 400) << x[i] << ", " << y[i];
    // As wide as 400 pixels, no letter is smaller than 9.
    for (const double points :
         numbers_of(chart_svg_file(small_chart(), FrameTime::single, ErrorOf::worse), "font-size: "))
        EXPECT_GE(points * 400 / 640, 9);
}

TEST(Chart, SetsOutliersOverABreakOfTheAxis) {
    Chart chart = small_chart();
    EXPECT_EQ(chart_svg(chart, FrameTime::single, ErrorOf::worse).find("above the break"), std::string::npos);
    const double height = 388; // of the plot
    const auto of = [&](const std::string& svg, const std::string& id) {
        const size_t at = svg.find("data-id='" + id + "'");
        return std::stod(svg.substr(svg.find("cy='", at) + 4));
    };
    const std::string even = chart_svg(chart, FrameTime::single, ErrorOf::worse);
    const double spread = of(even, "march.2") - of(even, "march.1");

    chart.points[3].errors.error = 37;
    const std::string broken = chart_svg(chart, FrameTime::single, ErrorOf::worse);
    EXPECT_NE(broken.find("above the break: billboard 3700 %"), broken.npos);
    EXPECT_NE(broken.find("class='break'"), broken.npos);
    EXPECT_GT(of(broken, "march.2") - of(broken, "march.1"), 0.8 * spread) << "the rest keeps its room";
    EXPECT_LT(spread, height);
}

TEST(Chart, IsDrawnInAFileOfItsOwnThatFollowsTheScreen) {
    const std::string file = chart_svg_file(small_chart(), FrameTime::sequence, ErrorOf::worse);
    EXPECT_EQ(file.find("<svg xmlns='http://www.w3.org/2000/svg'"), 0u);
    EXPECT_NE(file.find("@media (prefers-color-scheme: dark)"), file.npos);
    EXPECT_NE(file.find("class='paper'"), file.npos);
}

TEST(Chart, DrawsModesInColorsAndShapesOfTheirOwn) {
    std::set<std::string> colors;
    std::set<int> shapes;
    for (const Mode& mode : modes()) {
        colors.insert(style_of(std::string(mode.name)).color);
        shapes.insert(style_of(std::string(mode.name)).shape);
    }
    EXPECT_EQ(colors.size(), modes().size());
    EXPECT_EQ(shapes.size(), modes().size());
}
}
}
