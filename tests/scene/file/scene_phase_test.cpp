// Phase functions of scene files: every form, over time, with what is said of their numbers.
#include "scene/file/scene_file.h"
#include "support/load_answer.h"
#include "support/scratch.h"
#include "volume/phase/mie.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
LoadResult with_phase(const TempFolder& folder, const std::string& phase) {
    return load(
        folder.put("scene.json",
                   R"({"tyndall": 1, "media": [{"type": "homogeneous", "extinction": 1, "phase": )" + phase + "}]}"));
}

Phase phase_of(const TempFolder& folder, const std::string& phase, double seconds = 0) {
    const LoadResult answer = with_phase(folder, phase);
    EXPECT_TRUE(answer.loaded) << answer.message;
    const MediumSource& medium = answer.scene.media.at(0);
    return phase_at(medium.phase, medium.g.at(seconds), seconds);
}

void expect_same(const Phase& a, const Phase& b) {
    for (const double c : {-1.0, -0.5, 0.0, 0.7, 0.99, 1.0})
        EXPECT_NEAR(phase_value_of<double>(a, c) / phase_value_of<double>(b, c), 1, 1e-5) << c;
}

TEST(ScenePhase, HasEveryForm) {
    const TempFolder folder;
    const auto read = [&](const char* text) { return phase_of(folder, text); };
    const Phase narrow = read(R"({"type": "henyey_greenstein", "g": 0.7})");
    EXPECT_EQ(narrow.kind, PhaseKind::henyey_greenstein);
    EXPECT_FALSE(narrow.shape) << "the kernel of the plain form";
    EXPECT_FLOAT_EQ(narrow.g, 0.7f);
    expect_same(read(R"({"type": "rayleigh"})"), {PhaseKind::rayleigh});
    expect_same(read(R"({"type": "isotropic"})"), {PhaseKind::isotropic});
    expect_same(read(R"({"type": "draine", "g": 0.6, "alpha": 2})"), draine_phase(0.6, 2));
    expect_same(read(R"({"type": "mie", "droplet_diameter": 20})"), mie_phase(20));
    expect_same(read(R"({"type": "mix", "weight": 0.25, "lobes": [{"type": "mie", "droplet_diameter": 8},
                        {"type": "henyey_greenstein", "g": -0.3}]})"),
                mixed_phase(0.25, mie_phase(8), {PhaseKind::henyey_greenstein, -0.3f}));
    expect_same(read(R"({"type": "table", "values": [[0, 2], [180, 2]]})"), {PhaseKind::isotropic});
    expect_same(read(R"({"type": "legendre", "coefficients": [1, 0, 0.5]})"), {PhaseKind::rayleigh});
}

TEST(ScenePhase, ChangesOverTime) {
    const TempFolder folder;
    const auto at = [&](double seconds) {
        return phase_of(folder, R"({"type": "mix", "weight": {"keys": [[0, 0], [2, 1]]}, "lobes": [
            {"type": "mie", "droplet_diameter": {"keys": [[0, 10], [2, 30]]}}, {"type": "draine", "g": 0.2, "alpha": 1}]})",
                        seconds);
    };
    expect_same(at(0), draine_phase(0.2, 1));
    expect_same(at(1), mixed_phase(0.5, mie_phase(20), draine_phase(0.2, 1)));
    expect_same(at(2), mie_phase(30));
}

TEST(ScenePhase, TablesComeFromFilesToo) {
    const TempFolder folder;
    folder.put("bow.txt", "# degrees, 1/sr\r\n0, 4\n90\t1\n\n180 2 # glory\n");
    const Phase file = phase_of(folder, R"({"type": "table", "file": "bow.txt"})");
    expect_same(file, phase_of(folder, R"({"type": "table", "values": [[0, 4], [90, 1], [180, 2]]})"));
    folder.put("series.txt", "1 1.2\n0.8,0.4");
    expect_same(phase_of(folder, R"({"type": "legendre", "file": "series.txt"})"),
                phase_of(folder, R"({"type": "legendre", "coefficients": [1, 1.2, 0.8, 0.4]})"));
    EXPECT_EQ(with_phase(folder, R"({"type": "legendre", "file": "series.txt"})").scene.inputs.size(), 2u)
        << "changes of the file are noticed";
}

TEST(ScenePhase, NumbersThatAreMendedAreSaid) {
    const TempFolder folder;
    const auto warned = [&](const char* phase, const char* part) {
        const LoadResult answer = with_phase(folder, phase);
        EXPECT_TRUE(answer.loaded) << answer.message;
        return has_warning(answer.scene, part);
    };
    EXPECT_TRUE(warned(R"({"type": "table", "values": [[0, 1], [180, 1]]})", "integrate to 12.5664"));
    EXPECT_FALSE(warned(R"({"type": "table", "values": [[0, 0.0795775], [180, 0.0795775]]})", "integrate"));
    EXPECT_TRUE(warned(R"({"type": "legendre", "coefficients": [2, 1]})", "first coefficient is 2"));
    EXPECT_TRUE(warned(R"({"type": "legendre", "coefficients": [1, 1.05]})", "negative"));
    EXPECT_FALSE(warned(R"({"type": "legendre", "coefficients": [1, 0.9]})", "negative"));
}

TEST(ScenePhase, BrokenTablesAreNamedWithTheirLine) {
    const TempFolder folder;
    const auto refused = [&](const std::string& text, const char* part) {
        folder.put("bad.txt", text);
        expect_refusal(with_phase(folder, R"({"type": "table", "file": "bad.txt"})"), part);
    };
    refused("0 1\n90 x\n180 1\n", "line 2 of its file: expected a number, got \"x\"");
    refused("0 1\n90 nan\n180 1\n", "line 2");
    refused("0 1\n90 1e999\n180 1\n", "line 2");
    refused("0 1 180", "pairs");
    refused("", "at least two angles");
    refused(std::string("\x89PNG\0\0", 6), "line 1");
    expect_refusal(with_phase(folder, R"({"type": "table", "file": "none.txt"})"), "no such file",
                   ExitCode::unreadable);
    refused("0 1\n180 -1\n", "below 0");
}
}
}
