#include "scene/lights/gobo.h"

#include "base/io/file.h"
#include "scene/images/image_file.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
// A level of `texels` texels plus its border, all black.
Gobo::Level black_level(vec2 texels, int planes) {
    Gobo::Level level;
    level.texels = texels;
    level.size = ivec2(glm::ceil(texels - 1e-3f)) + 2;
    level.values.assign(static_cast<size_t>(planes) * level.size.x * level.size.y, 0.0f);
    return level;
}

// Averages blocks of 2 × 2 texels; black beyond the image.
Gobo::Level halved(const Gobo::Level& fine, int planes) {
    Gobo::Level coarse = black_level(0.5f * fine.texels, planes);
    for (int plane = 0; plane < planes; ++plane) {
        float* to = coarse.values.data() + static_cast<size_t>(plane) * coarse.size.x * coarse.size.y;
        const float* from = fine.plane(plane);
        for (int y = 1; y < fine.size.y - 1; ++y)
            for (int x = 1; x < fine.size.x - 1; ++x)
                to[((y - 1) / 2 + 1) * coarse.size.x + (x - 1) / 2 + 1] += 0.25f * from[y * fine.size.x + x];
    }
    return coarse;
}

bool is_gray(const Image<vec3>& image) {
    return std::ranges::all_of(image.pixels, [](vec3 c) { return c.x == c.y && c.y == c.z; });
}
}

namespace {
std::shared_ptr<Gobo> gobo_of(const ReducedImage& picture) {
    auto gobo = std::make_shared<Gobo>();
    gobo->planes = is_gray(picture.image) ? 1 : 3;
    gobo->aspect = static_cast<float>(picture.size.y) / static_cast<float>(picture.size.x);
    Gobo::Level& level =
        gobo->levels.emplace_back(black_level(vec2(picture.size) / static_cast<float>(picture.factor), gobo->planes));
    const size_t plane = static_cast<size_t>(level.size.x) * level.size.y;
    for (int y = 0; y < picture.image.size.y; ++y)
        for (int x = 0; x < picture.image.size.x; ++x)
            for (int c = 0; c < gobo->planes; ++c)
                level.values[c * plane + static_cast<size_t>((y + 1) * level.size.x + x + 1)] =
                    std::max(picture.image.at(x, y)[c], 0.0f);
    while (std::max(gobo->levels.back().texels.x, gobo->levels.back().texels.y) > 1)
        gobo->levels.push_back(halved(gobo->levels.back(), gobo->planes));
    return gobo;
}
}

std::shared_ptr<Gobo> make_gobo(std::string_view bytes, ColorSpace space, std::string_view where, std::string& note) {
    const ReducedImage picture =
        decode_reduced(bytes, space == ColorSpace::linear, largest_gobo_side, reduced_gobo_side, where, note);
    if (picture.factor > 1)
        note += (note.empty() ? "" : "; ") + std::to_string(picture.size.x) + "x" + std::to_string(picture.size.y) +
                " pixels, downsampled by a factor of " + std::to_string(picture.factor);
    std::shared_ptr<Gobo> gobo = gobo_of(picture);
    gobo->content = content_hash(bytes);
    if (std::ranges::all_of(gobo->levels[0].values, [](float value) { return value == 0; }))
        note += std::string(note.empty() ? "" : "; ") + "the image is black";
    return gobo;
}

std::shared_ptr<Gobo> make_gobo(const Image<vec3>& image) { return gobo_of({image.size, 1, image}); }

dvec3 gobo_at(const Gobo& gobo, double u, double v) {
    const Gobo::Level& level = gobo.levels[0];
    // Texel centers lie at half-integers; the border comes first.
    const auto place = [](double at, float texels, int size) {
        return std::clamp(at * texels + 0.5, 0.0, static_cast<double>(size - 1));
    };
    const double x = place(u, level.texels.x, level.size.x), y = place(v, level.texels.y, level.size.y);
    const int i = std::min(static_cast<int>(x), level.size.x - 2), j = std::min(static_cast<int>(y), level.size.y - 2);
    dvec3 color;
    for (int c = 0; c < gobo.planes; ++c) {
        const float* texel = level.plane(c) + static_cast<size_t>(j) * level.size.x + i;
        const double top = std::lerp(double{texel[0]}, double{texel[1]}, x - i);
        texel += level.size.x;
        color[c] = std::lerp(top, std::lerp(double{texel[0]}, double{texel[1]}, x - i), y - j);
    }
    return gobo.planes == 3 ? color : dvec3(color.x);
}

int gobo_level(const Gobo& gobo, float share) {
    int level = 0;
    while (level + 1 < static_cast<int>(gobo.levels.size()) &&
           2 / gobo.levels[static_cast<size_t>(level)].texels.x < share)
        ++level;
    return level;
}
}
