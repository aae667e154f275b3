// Light that gobos and IES profiles send through fog and onto a floor, in the modes that show them, against integrals
// of the image and of the file with a projection of their own: color space, axes, cone and angles are written out here.
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/frame/frame.h"
#include "render/sequence/job.h"
#include "scene/camera.h"
#include "scene/images.h"
#include "scene/lights/light_filter.h"
#include "scene/scene.h"
#include "support/scratch.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

namespace tyndall::test {
namespace {
constexpr double sigmas = 4.5; // a false alarm once in 150000 comparisons

// A lamp above a slab of fog, 0 < y < 1, on a white floor.
const dvec3 lamp(-0.4, 2.6, 0.2), aim(0.3, -1, -0.15), tilted(0.2, 0.3, -1);
constexpr double extinction = 0.5, g = 0.4;

// A lamp's part of a scene file, the file that it reads, and its candela towards (right, up, ahead) of an observer who
// looks along it, turned counterclockwise with the image or the planes.
struct Projection {
    std::string name, light, file, bytes;
    dvec3 up{0, 1, 0};
    double turned = 0; // degrees
    std::function<dvec3(dvec3)> candela;
};

// Linear interpolation between values that lie 1 apart.
double tent(double x) { return std::max(0.0, 1 - std::abs(x)); }

constexpr ivec2 texels(6, 4);
int code_of(int x, int y, int channel) { return 30 + (61 * x + 97 * y + 40 * channel * x) % 226; }

std::string image_file() {
    std::vector<std::array<uint8_t, 4>> codes(static_cast<size_t>(texels.x * texels.y), {0, 0, 0, 255});
    for (size_t i = 0; i < codes.size(); ++i)
        for (int c = 0; c < 3; ++c)
            codes[i][static_cast<size_t>(c)] =
                static_cast<uint8_t>(code_of(static_cast<int>(i) % texels.x, static_cast<int>(i) / texels.x, c));
    return png_of(texels, codes);
}

// Linear between the middles of texels, (0, 0) at the upper left, black outside; sRGB as in IEC 61966-2-1.
dvec3 image_at(double u, double v, bool srgb) {
    const auto light = [&](double code) {
        return !srgb ? code : code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
    };
    dvec3 sum(0);
    for (int y = 0; y < texels.y; ++y)
        for (int x = 0; x < texels.x; ++x) {
            const double weight = tent(u * texels.x - 0.5 - x) * tent(v * texels.y - 0.5 - y);
            for (int c = 0; c < 3 && weight > 0; ++c) sum[c] += weight * light(code_of(x, y, c) / 255.0);
        }
    return sum;
}

// KHR_lights_punctual's falloff between half angles of 8 and 26 degrees.
double cone_at(double cosine) {
    const double low = std::cos(glm::radians(26.0)), high = std::cos(glm::radians(8.0));
    return std::pow(std::clamp((cosine - low) / (high - low), 0.0, 1.0), 2);
}

// An image as wide as the cone times `scale`.
Projection gobo(bool srgb, double scale, dvec3 up, double turned) {
    const auto candela = [=](dvec3 way) {
        if (way.z <= 0) return dvec3(0);
        const dvec3 at = way / way.z / (scale * std::tan(glm::radians(26.0)));
        return 50 * cone_at(way.z) * image_at(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y * texels.x / texels.y, srgb);
    };
    const std::string space = srgb ? "srgb" : "linear";
    return {space + " image",
            R"("type": "spot", "inner_cone": 8, "outer_cone": 26, "intensity": 50, "gobo": {"image": "image.png",
               "color_space": ")" +
                space + R"(", "scale": )" + std::to_string(scale) + R"(, "rotate": )" + std::to_string(turned) + "}",
            "image.png",
            image_file(),
            up,
            turned,
            candela};
}

// Candela of an IES file whose angles are `first` + i `step`, 0 at the outermost ones.
struct Angles {
    int first, step, count;
    bool is_last(int i) const { return i == count - 1; }
    double place(double angle) const { return (angle - first) / step; }
};
double candela_of(int v, int h) { return 40 + 23 * ((3 * v + 5 * h + v * h) % 7); }

std::string ies_file(int type, const Angles& vertical, const Angles& horizontal,
                     const std::function<double(int, int)>& candela) {
    std::string text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1.5 " + std::to_string(vertical.count) + " " +
                       std::to_string(horizontal.count) + " " + std::to_string(type) + " 2 0 0 0\n1 1 10\n";
    for (const Angles& angles : {vertical, horizontal})
        for (int i = 0; i < angles.count; ++i)
            text += std::to_string(angles.first + i * angles.step) + (angles.is_last(i) ? "\n" : " ");
    for (int h = 0; h < horizontal.count; ++h)
        for (int v = 0; v < vertical.count; ++v)
            text += std::to_string(candela(v, h)) + (vertical.is_last(v) ? "\n" : " ");
    return text;
}

Projection profile(const std::string& name, double turned, const std::string& bytes,
                   const std::function<double(dvec3)>& candela) {
    const std::string light =
        R"("type": "point", "ies": {"file": "lamp.ies", "rotate": )" + std::to_string(turned) + "}";
    return {name, light, "lamp.ies", bytes, tilted, turned, [=](dvec3 way) { return dvec3(1.5 * candela(way)); }};
}

// Angles from the aim, and around it from the right to the top.
Projection type_c(double turned) {
    constexpr Angles vertical{0, 15, 4}, horizontal{0, 45, 9};
    const auto at = [=](int v, int h) { return v == 0 ? 150 : vertical.is_last(v) ? 0 : candela_of(v, h % 8); };
    const auto candela = [=](dvec3 way) {
        const double turn = glm::degrees(std::atan2(way.y, way.x)), around = turn < 0 ? turn + 360 : turn;
        const double row = vertical.place(glm::degrees(std::acos(std::clamp(way.z, -1.0, 1.0))));
        double sum = 0;
        for (int v = 0; v < vertical.count; ++v)
            for (int h = 0; h < horizontal.count; ++h)
                sum += tent(row - v) * tent(horizontal.place(around) - h) * at(v, h);
        return sum;
    };
    return profile("type C", turned, ies_file(1, vertical, horizontal, at), candela);
}

// To the right by angles from an upright plane, which turns up about the axis across (IES LM-75).
Projection type_b(double turned) {
    constexpr Angles vertical{-36, 12, 7}, horizontal{-32, 16, 5};
    const auto at = [=](int v, int h) {
        return v * h == 0 || vertical.is_last(v) || horizontal.is_last(h) ? 0 : candela_of(v, h);
    };
    const auto candela = [=](dvec3 way) {
        const double row = vertical.place(glm::degrees(std::atan2(way.y, way.z)));
        const double plane = horizontal.place(glm::degrees(std::asin(std::clamp(way.x, -1.0, 1.0))));
        double sum = 0;
        for (int v = 0; v < vertical.count; ++v)
            for (int h = 0; h < horizontal.count; ++h) sum += tent(row - v) * tent(plane - h) * at(v, h);
        return sum;
    };
    return profile("type B", turned, ies_file(2, vertical, horizontal, at), candela);
}

// What reaches a point through the fog above it, per square meter across the way.
dvec3 arriving(const Projection& projection, dvec3 point) {
    const dvec3 ahead = glm::normalize(aim), off = point - lamp, way = glm::normalize(off);
    const dvec3 up = glm::normalize(projection.up - glm::dot(projection.up, ahead) * ahead);
    const double x = glm::dot(way, glm::cross(ahead, up)), y = glm::dot(way, up);
    const double turn = glm::radians(projection.turned), c = std::cos(turn), s = std::sin(turn);
    const double in_fog = glm::length(off) * (1 - point.y) / (lamp.y - point.y);
    return projection.candela({c * x + s * y, c * y - s * x, glm::dot(way, ahead)}) * std::exp(-extinction * in_fog) /
           glm::dot(off, off);
}

struct Seen {
    dvec3 fog{0}, floor{0};
};
// Along a ray inside the slab and down to the floor: scattered once, by Henyey and Greenstein, and off the floor.
Seen seen_along(const Projection& projection, const Ray& ray) {
    constexpr int steps = 500;
    const dvec3 eye(ray.origin), way(ray.direction);
    const double length = -eye.y / way.y;
    Seen seen;
    for (int i = 0; i < steps; ++i) {
        const double along = length * (i + 0.5) / steps;
        const dvec3 point = eye + along * way;
        const double cosine = -glm::dot(glm::normalize(point - lamp), way);
        const double phase = (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
        seen.fog += arriving(projection, point) * (extinction * phase * std::exp(-extinction * along) * length / steps);
    }
    const dvec3 foot = eye + length * way;
    const double slant = lamp.y / glm::distance(foot, lamp);
    seen.floor = arriving(projection, foot) * (slant * std::numbers::inv_pi * std::exp(-extinction * length));
    return seen;
}

struct Stage {
    TempFolder scratch;
    Scene scene;
    RenderRequest request;

    explicit Stage(const Projection& projection) {
        const auto list = [](dvec3 v) {
            return "[" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + "]";
        };
        scratch.put(projection.file, projection.bytes);
        const std::string head = R"({"tyndall": 1, "resolution": [16, 12], "background": {"color": 0},
            "camera": {"position": [1.6, 0.95, 1.4], "target": [0.1, 0, -0.1], "vertical_fov": 36},
            "media": [{"type": "homogeneous", "extinction": 0.5, "g": 0.4, "albedo": 1,
                       "bounds": {"low": [-30, -1, -30], "high": [30, 1, 30]}}], "lights": [{"position": )";
        scene = load_scene_text(head + list(lamp) + R"(, "direction": )" + list(aim) + R"(, "up": )" +
                                    list(projection.up) + ", " + projection.light + "}]}",
                                scratch / "scene.json");
        scene.materials.push_back(lambert(vec3(1)));
        scene.meshes.push_back(floor_of(0, 30, 0)), scene.instances.push_back({-1, 0});
    }
    Snapshot snapshot() const { return make_snapshot(scene, Moment{0, 0}); }
    View view() const { return view_of(scene, request, request.settings, 0); }
    Layers rendered(const char* mode, Quality quality, int samples) {
        request.settings = settings_for(quality);
        request.settings.pixel.filter = PixelFilter::center, request.settings.pixel.samples = samples;
        request.settings.path.orders = request.settings.fluence.orders = 1;
        request.exr.layers = {"surface", "variance"};
        FrameStats stats;
        return render_frame(find_mode(mode), view(), snapshot(), request.settings, {}, stats);
    }
};

std::vector<Seen> seen_by(const Projection& projection, const View& view) {
    std::vector<Seen> seen;
    for (int y = 0; y < view.size.y; ++y)
        for (int x = 0; x < view.size.x; ++x)
            seen.push_back(seen_along(projection, camera_ray(view.camera, view.size, vec2(x, y) + 0.5f)));
    return seen;
}

// Within half a percent of the brightest pixel everywhere: tables of type B are interpolated twice, in cells half as
// wide as the file's, and the steps of shadow-map are as coarse.
void expect_pixels(const Image<vec3>& image, const std::vector<Seen>& seen, dvec3 Seen::*part,
                   const std::string& what) {
    dvec3 brightest(0);
    for (const Seen& one : seen) brightest = glm::max(brightest, one.*part);
    for (size_t i = 0; i < seen.size(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(image.pixels[i][c], (seen[i].*part)[c], 0.005 * brightest[c]) << what << " at " << i;
}

// Noise: the mean of the image within its error, of half a percent, and pixels that differ by as much as they may.
void expect_noise(const Layers& layers, const std::vector<Seen>& seen, const std::string& what) {
    for (int c = 0; c < 3; ++c) {
        double sum = 0, expected = 0, variance = 0, squares = 0;
        for (size_t i = 0; i < seen.size(); ++i) {
            const double off = double{layers.inscatter.pixels[i][c]} - seen[i].fog[c];
            sum += off, squares += off * off, expected += seen[i].fog[c];
            variance += double{layers.inscatter_variance.pixels[i][c]};
        }
        EXPECT_NEAR(sum / expected, 0, sigmas * std::sqrt(variance) / expected) << what << ", channel " << c;
        EXPECT_LT(sigmas * std::sqrt(variance), 0.005 * expected) << what;
        EXPECT_LT(squares, 2 * variance) << what << ": the sum of 192 squares varies by a tenth";
    }
}

// `march` and `shadow-volume` at `reference`: otherwise four nodes span 60 degrees of these profiles.
void expect_integral(const Projection& projection, int paths) {
    Stage stage(projection);
    const std::vector<Seen> seen = seen_by(projection, stage.view());
    const auto what = [&](const char* mode) {
        return projection.name + " turned by " + std::to_string(projection.turned) + ", " + mode;
    };
    const std::tuple<const char*, Quality, int> rows[] = {{"march", Quality::reference, 1},
                                                          {"shadow-volume", Quality::reference, 1},
                                                          {"froxel", Quality::final, 4},
                                                          {"shadow-map", Quality::final, 16},
                                                          {"cone", Quality::final, 4}};
    for (const auto& [mode, quality, samples] : rows) {
        const Layers layers = stage.rendered(mode, quality, samples);
        expect_pixels(layers.inscatter, seen, &Seen::fog, what(mode) + ", fog");
        expect_pixels(layers.surface, seen, &Seen::floor, what(mode) + ", floor");
    }
    const Layers layers = stage.rendered("path", Quality::final, paths);
    expect_noise(layers, seen, what("path"));
    expect_pixels(layers.surface, seen, &Seen::floor, what("path") + ", floor");
}

TEST(ProjectedLight, OfGobosIsTheIntegralOfTheirImage) {
    expect_integral(gobo(true, 1, {0, 1, 0}, 0), 4096);
    expect_integral(gobo(false, 0.7, tilted, 25), 4096); // all of the image, with black around it
}

TEST(ProjectedLight, OfProfilesIsTheIntegralOfTheirFile) {
    for (const double turned : {0.0, 35.0}) expect_integral(type_c(turned), 128), expect_integral(type_b(turned), 128);
}

// What billboard and radial-blur have instead.
TEST(ProjectedLight, MeanOfAGoboIsThatOfItsImageInTheCone) {
    for (const Projection& projection : {gobo(true, 1, {0, 1, 0}, 0), gobo(false, 0.7, tilted, 25)}) {
        constexpr int rings = 200, around = 200;
        dvec3 sum(0);
        double cone = 0;
        for (int i = 0; i < rings * around; ++i) {
            const double z = 1 - (1 - std::cos(glm::radians(26.0))) * (i / around + 0.5) / rings;
            const double across = std::sqrt(1 - z * z), turn = 2 * std::numbers::pi * (i % around + 0.5) / around;
            sum += projection.candela({across * std::cos(turn), across * std::sin(turn), z}), cone += cone_at(z);
        }
        const Stage stage(projection);
        const vec3 mean = mean_factor(stage.snapshot().lights[0]).mean;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], sum[c] / (50 * cone), 0.005 * mean[c]) << projection.name;
    }
}
}
}
