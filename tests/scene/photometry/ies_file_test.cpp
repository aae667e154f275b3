// IES files: what their numbers mean, and files that are cut, absurd or of other kinds.
#include "base/io/file.h"
#include "scene/photometry/ies_file.h"
#include "support/corpus.h"
#include "support/expect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace tyndall {
namespace {
constexpr double exact_pi = 3.14159265358979323846;

// A file of two planes' worth of numbers, with room for changes.
std::string text_of(const std::string& numbers,
                    const std::string& head = "IESNA:LM-63-2002\n[LUMCAT] test\nTILT=NONE\n") {
    return head + numbers;
}
const std::string plain = text_of("1 -1 2 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n100 80 20\n");

dvec3 direction(double vertical, double horizontal) {
    const double v = vertical * exact_pi / 180, h = horizontal * exact_pi / 180;
    return {std::sin(v) * std::cos(h), std::sin(v) * std::sin(h), std::cos(v)};
}

TEST(IesFile, MultipliersAndBallastAreInTheCandela) {
    const IesFile file = read_ies(plain, "a.ies");
    EXPECT_EQ(file.standard, "LM-63-2002");
    EXPECT_TRUE(file.absolute());
    EXPECT_DOUBLE_EQ(file.peak(), 200);
    EXPECT_NEAR(candela_at(file, direction(22.5, 130)), 180, 1e-9);
    EXPECT_EQ(candela_at(file, direction(91, 0)), 0);
    // Until 1995 the second factor is one of lamp and ballast, in 2019 a code.
    EXPECT_DOUBLE_EQ(read_ies(replaced(plain, "\n1 1 10", "\n.9 .5 10"), "a.ies").peak(), 90);
    const IesFile newest = read_ies(
        replaced(replaced(plain, "IESNA:LM-63-2002", "IES:LM-63-2019"), "\n1 1 10", "\n1 1.10001 10"), "a.ies");
    EXPECT_DOUBLE_EQ(newest.peak(), 200);
    EXPECT_DOUBLE_EQ(newest.generation, 1.10001);
}

TEST(IesFile, OneNumberALineCommasAndOldLineEndsAreTheSame) {
    std::string lines = plain;
    for (char& c : lines)
        if (c == ' ' && lines.find("TILT") < static_cast<size_t>(&c - lines.data())) c = '\n';
    std::string old;
    for (const char c : plain) old += c == '\n' ? std::string("\r\n") : std::string(1, c);
    for (const std::string& text :
         {lines, old, "\xef\xbb\xbf" + plain, plain + "\x1a garbage", replaced(plain, "test", "\xfc\xe9"),
          replaced(plain, "100 80 20", "100, 80, 20"), replaced(plain, "IESNA:LM-63-2002", "Some lamp")})
        EXPECT_EQ(read_ies(text, "a.ies").candela, read_ies(plain, "a.ies").candela);
}

TEST(IesFile, HeadsInAnyCaseAndBlanksAroundTheTilt) {
    const std::string older = replaced(plain, "\n1 1 10", "\n.9 .5 10");
    const IesFile newest = read_ies(replaced(older, "IESNA:LM-63-2002", "ies:lm-63-2019"), "a.ies");
    EXPECT_EQ(newest.standard, "LM-63-2019");
    EXPECT_DOUBLE_EQ(newest.peak(), 180);
    EXPECT_EQ(read_ies(replaced(plain, "IESNA:LM-63-2002", "iesna91"), "a.ies").standard, "LM-63-1991");
    for (const char* tilt : {"TILT = NONE", "tilt= none", "Tilt =None "})
        EXPECT_EQ(read_ies(replaced(plain, "TILT=NONE", tilt), "a.ies").tilt, "NONE") << tilt;
}

TEST(IesFile, PlanesAreMirroredAsTheStandardSays) {
    const auto planes = [](const std::string& angles, const std::string& rows) {
        const auto count = std::to_string(std::count(angles.begin(), angles.end(), ' ') + 1);
        return read_ies(text_of("1 -1 1 2 " + count + " 1 2 0 0 0\n1 1 0\n0 90\n" + angles + "\n" + rows), "a.ies");
    };
    const IesFile quarter = planes("0 90", "10 10\n10 30\n");
    for (const double h : {30.0, 150.0, 210.0, 330.0})
        EXPECT_NEAR(candela_at(quarter, direction(90, h)), 10 + 20.0 / 3, 1e-9) << h;
    const IesFile half = planes("0 90 180", "10 10\n10 20\n10 40\n");
    EXPECT_NEAR(candela_at(half, direction(90, 135)), 30, 1e-9);
    EXPECT_NEAR(candela_at(half, direction(90, 225)), 30, 1e-9);
    const IesFile back = planes("90 180 270", "10 10\n10 20\n10 40\n");
    EXPECT_NEAR(candela_at(back, direction(90, 135)), 15, 1e-9);
    EXPECT_NEAR(candela_at(back, direction(90, 45)), 15, 1e-9);
    EXPECT_NEAR(candela_at(back, direction(90, 225)), 30, 1e-9);
    EXPECT_NEAR(candela_at(back, direction(90, 315)), 30, 1e-9);
    const IesFile full = planes("0 90 180 270 360", "10 10\n10 20\n10 30\n10 40\n10 10\n");
    EXPECT_NEAR(candela_at(full, direction(90, 315)), 25, 1e-9);
    const IesFile open = planes("0 90 180 270", "10 10\n10 20\n10 30\n10 40\n");
    EXPECT_NEAR(candela_at(open, direction(90, 315)), 25, 1e-9);
    EXPECT_EQ(open.notes.size(), 1u);
}

TEST(IesFile, LumensAreTheIntegralOverTheSphere) {
    // Constant candela over the lower half: 2π; a lobe of cos θ: π, but for the chords between angles.
    EXPECT_NEAR(zonal_lumens(read_ies(text_of("1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n5 5\n"), "a.ies")), 10 * exact_pi,
                1e-9);
    std::string angles, values;
    for (int i = 0; i <= 90; ++i)
        angles += std::to_string(i) + " ", values += std::to_string(std::cos(i * exact_pi / 180)) + " ";
    const std::string lobe = text_of("1 -1 1 91 1 1 2 0 0 0\n1 1 0\n" + angles + "\n0\n" + values);
    EXPECT_NEAR(zonal_lumens(read_ies(lobe, "a.ies")), exact_pi, 1e-4);
    // The same lobe in types B and A, by the angles of their own.
    for (const char type : {'2', '3'}) {
        std::string rows;
        for (int h = 0; h <= 90; h += 2)
            for (int v = 0; v <= 90; v += 2)
                rows += std::to_string(std::cos(h * exact_pi / 180) * std::cos(v * exact_pi / 180)) + " ";
        std::string even;
        for (int i = 0; i <= 90; i += 2) even += std::to_string(i) + " ";
        const std::string text =
            text_of(std::string("1 -1 1 46 46 ") + type + " 2 0 0 0\n1 1 0\n" + even + "\n" + even + "\n" + rows);
        const IesFile file = read_ies(text, "a.ies");
        EXPECT_NEAR(zonal_lumens(file), exact_pi, 2e-3) << type;
        for (const dvec3 d : {dvec3(0.3, 0.2, 0.9), dvec3(-0.5, 0.4, 0.4), dvec3(0.1, -0.9, 0.2)})
            EXPECT_NEAR(candela_at(file, glm::normalize(d)), glm::normalize(d).z, 2e-3) << type;
        EXPECT_EQ(candela_at(file, dvec3(0, 0, -1)), 0);
    }
}

TEST(IesFile, TypeBTurnsAboutTheAxisAcross) {
    // Brightest at 40 degrees to the right, 20 up; the poles of H = ±90 are single points.
    const std::string angles = "-90 0 20 40 90\n";
    const auto rows = [](int plane) {
        std::string text;
        for (int v = 0; v < 5; ++v) text += plane == 3 && v == 2 ? "9 " : "1 ";
        return text + "\n";
    };
    std::string text = "1 -1 1 5 5 2 2 0 0 0\n1 1 0\n" + angles + angles;
    for (int plane = 0; plane < 5; ++plane) text += rows(plane);
    const IesFile file = read_ies(text_of(text), "b.ies");
    const double h = 40 * exact_pi / 180, v = 20 * exact_pi / 180;
    EXPECT_NEAR(candela_at(file, {std::sin(h), std::cos(h) * std::sin(v), std::cos(h) * std::cos(v)}), 9, 1e-9);
    EXPECT_NEAR(candela_at(file, {-std::sin(h), std::cos(h) * std::sin(v), std::cos(h) * std::cos(v)}), 1, 1e-9);
}

TEST(IesFile, DamagedFilesAreRefusedInOneLine) {
    const std::pair<std::string, const char*> cases[] = {
        {"", "TILT="},
        {"solid ascii of something else\n", "TILT="},
        {plain.substr(0, plain.find(" 20\n")), "ends before a candela value"},
        {replaced(plain, "2 3 1 1 2", "2 1000000000 1 1 2"), "room for"},
        {replaced(plain, "2 3 1 1 2", "2 3 1000000000 1 2"), "room for"},
        {replaced(plain, "2 3 1 1 2", "2 14 14 1 2"), "room for"},
        {replaced(plain, "2 3 1 1 2", "2 -3 1 1 2"), "number of vertical angles is -3"},
        {replaced(plain, "2 3 1 1 2", "2 2.5 1 1 2"), "2.5"},
        {replaced(plain, "2 3 1 1 2", "2 3 1 7 2"), "photometric type is 7"},
        {replaced(plain, "100 80", "nan 80"), "candela value"},
        {replaced(plain, "100 80", "1e999 80"), "candela value"},
        {replaced(plain, "100 80", "1e300 80"), "over 1e15"},
        {replaced(plain, "100 80", "ten 80"), "\"ten\""},
        {replaced(plain, "0 45 90", "0 95 90"), "angles must ascend"},
        {replaced(plain, "0 45 90", "0 45 450"), "450"},
        {replaced(plain, "0 45 90", "0 180 180.005"), "180 and the next one 180.005: both count as 180"},
        {replaced(plain, "0 45 90", "-.005 0 90"), "-0.005 and the next one 0: both count as 0"},
        {replaced(plain, "100 80 20", "0 0 0"), "no light"},
        {replaced(plain, "100 80 20", "100,5 80,2 20,1"), "decimal commas"},
        {plain + "7\n", "an angle count is wrong"},
        {replaced(plain, "TILT=NONE", "TILT=INCLUDE\n1\n1000000000"), "room for"},
        {text_of("1 -1 1 2 2 1 2 0 0 0\n1 1 0\n0 90\n10 50\n1 1 1 1\n"), "10 to 50"},
    };
    for (const auto& [text, part] : cases) {
        const std::string message = error_message(ExitCode::refused, [&] { read_ies(text, "bad.ies"); });
        EXPECT_NE(message.find(part), std::string::npos) << message << " for " << part;
    }
    // Cut anywhere: refused, or whole.
    for (size_t end = 0; end < plain.size(); ++end) {
        const Error error = error_of([&] { read_ies(plain.substr(0, end), "cut.ies"); });
        EXPECT_TRUE(error.code == ExitCode::refused || end > plain.find(" 20")) << end;
    }
}

TEST(IesFile, TiltFactorsAreReadAndSaid) {
    const IesFile file = read_ies(replaced(plain, "TILT=NONE", "TILT=INCLUDE\n1\n2\n0 90\n1 .8"), "a.ies");
    EXPECT_EQ(file.tilt, "INCLUDE");
    ASSERT_EQ(file.notes.size(), 1u);
    EXPECT_EQ(file.notes[0], "its tilt factors, 0.8 to 1, are not applied: they depend on how it is mounted");
    EXPECT_DOUBLE_EQ(file.peak(), 200);
    EXPECT_EQ(read_ies(replaced(plain, "TILT=NONE", "TILT=lamp.tlt"), "a.ies").notes.size(), 1u);
}

TEST(IesFile, MoreLightThanItsLampsGiveIsSaid) {
    const double lumens = zonal_lumens(read_ies(plain, "a.ies"));
    const auto notes = [&](double lamps) {
        return read_ies(replaced(plain, "\n1 -1 2", "\n2 " + std::to_string(lamps / 2) + " 2"), "a.ies").notes;
    };
    EXPECT_TRUE(notes(lumens / 0.9).empty());
    EXPECT_TRUE(notes(lumens / 1.1).empty());
    ASSERT_EQ(notes(lumens / 3.23).size(), 1u);
    EXPECT_NE(notes(lumens / 3.23)[0].find("323 % of the"), std::string::npos) << notes(lumens / 3.23)[0];
    EXPECT_TRUE(read_ies(plain, "a.ies").notes.empty()) << "absolute photometry";
}

TEST(IesFile, RealFilesHaveTheirLumens) {
    // Of this collection's own account: zonal sums, or the laboratory's number.
    const std::map<std::string, double> known = {
        {"6.ies", 3062},    {"12.IES", 33.1},   {"light.ies", 232}, {"profile.ies", 4777}, {"02a7.ies", 9600},
        {"00c6.ies", 2044}, {"1aec.ies", 2342}, {"108b.ies", 40.0}, {"1a93.ies", 2438},    {"1.IES", 9217.18},
        {"2.IES", 5834.2},  {"6.IES", 9230.16}, {"7.IES", 531.98},  {"examp1.ies", 5297}};
    size_t found = 0;
    for (const auto& path : test::corpus_files("ies", {".ies", ".IES"})) {
        const IesFile file = read_ies(read_file(path), path.string());
        EXPECT_GT(file.peak(), 0) << path;
        const auto row = known.find(path.filename().string());
        if (row == known.end()) continue;
        EXPECT_NEAR(zonal_lumens(file) / row->second, 1, 0.01) << path;
        ++found;
    }
    EXPECT_GE(found, 4u);
}
}
}
