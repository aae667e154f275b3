// The sums of the radial blur, for 16 pixels of a row at a time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/radial_blur/kernel.cpp"
#include <hwy/foreach_target.h>

#include "modes/radial_blur/glow.h"

#include "base/parallel.h"
#include "base/random.h"
#include "base/simd/gather_simd.h"
#include "base/simd/reduce_simd.h"
#include "base/simd/simd.h"
#include "trace/view.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
alignas(64) constexpr float lane_numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

// Centers of the pixels of a row from x0 on, clamped to its last.
HWY_INLINE Floats middles(int x0, int width) {
    const float last = static_cast<float>(width) - 0.5f;
    return min(load(lane_numbers) + (static_cast<float>(x0) + 0.5f), last);
}

// Bilinear look-ups at positions from -1 to size + 1.
struct Taps {
    Ints index;
    Floats u, v;

    HWY_INLINE Taps(const Floats& x, const Floats& y, int stride) {
        const Floats px = x + (BlurImage::frame - 0.5f), py = y + (BlurImage::frame - 0.5f);
        const Ints column = truncate(px), row = truncate(py);
        u = px - to_floats(column), v = py - to_floats(row);
        index = row * stride + column;
    }

    HWY_INLINE Floats of(const Image<float>& plane) const {
        Floats a, b, c, d;
        gather_pairs(plane.pixels.data(), index, a, b);
        gather_pairs(plane.pixels.data() + plane.size.x, index, c, d);
        const Floats upper = fma(b - a, u, a), lower = fma(d - c, u, c);
        return fma(lower - upper, v, upper);
    }
};

// Sample positions (x, y) + i·step of 16 pixels; those that may not be black have i in low..high.
struct Lines {
    Floats x, y, step_x, step_y;
    int low, high;
};

// Narrows low..high to the i for which from + i·step lies within a pixel of 0..size.
HWY_INLINE void keep_inside(const Floats& from, const Floats& step, int size, Floats& low, Floats& high) {
    const Mask16 still = abs(step) < 1e-12f;
    const Floats inverse = 1.0f / select(still, 1.0f, step);
    const Floats a = (-1.0f - from) * inverse, b = (static_cast<float>(size) + 1 - from) * inverse;
    low = select(still, low, max(low, min(a, b))), high = select(still, high, min(high, max(a, b)));
}

HWY_INLINE Lines lines_to(vec2 center, float radius, const BlurLine& line, ivec2 size, const Floats& x, const Floats& y,
                          const Floats& shift) {
    const float count = static_cast<float>(line.weights.size());
    Lines lines;
    lines.step_x = (center.x - x) * (line.density / count), lines.step_y = (center.y - y) * (line.density / count);
    lines.x = fma(shift, lines.step_x, x), lines.y = fma(shift, lines.step_y, y);

    // Samples outside are black: the loop covers those that are inside for any of the 16 pixels.
    Floats low = 0.0f, high = count - 1;
    const Floats off_x = center.x - lines.x, off_y = center.y - lines.y;
    const Floats away = sqrt(fma(off_x, off_x, off_y * off_y));
    const Floats entry = (1.0f - radius / max(away, 1e-6f)) * (count / line.density) - 1.0f;
    low = select(away > radius, max(low, entry), low);
    keep_inside(lines.x, lines.step_x, size.x, low, high);
    keep_inside(lines.y, lines.step_y, size.y, low, high);
    lines.low = static_cast<int>(std::ceil(std::max(least(low) - 1e-3f, 0.0f)));
    lines.high = static_cast<int>(std::min(most(high) + 1e-3f, count - 1));
    return lines;
}

template<size_t planes>
HWY_INLINE void sum_along(const Lines& lines, const BlurLine& line, const BlurImage& source, Floats* sums) {
    const float right = static_cast<float>(source.size.x) + 1, bottom = static_cast<float>(source.size.y) + 1;
    const int stride = source.planes[0].size.x;
    for (int i = lines.low; i <= lines.high; ++i) {
        const float k = static_cast<float>(i);
        const Floats x = min(max(fma(lines.step_x, k, lines.x), -1.0f), right);
        const Floats y = min(max(fma(lines.step_y, k, lines.y), -1.0f), bottom);
        const Taps taps(x, y, stride);
        for (size_t p = 0; p < planes; ++p)
            sums[p] = fma(taps.of(source.planes[p]), line.weights[static_cast<size_t>(i)], sums[p]);
    }
}

void blur_row_kernel(const BlurImage& source, const BlurLine& line, vec2 center, float radius, const View& view, int y,
                     BlurImage& result) {
    for (int x0 = 0; x0 < source.size.x; x0 += 16) {
        alignas(64) float shift[16], pixels[16];
        for (int i = 0; i < 16; ++i) shift[i] = to_unit(jitter_bits(view.jitter, {x0 + i, y}, view.frame, view.seed));
        const Floats x = middles(x0, source.size.x), middle = static_cast<float>(y) + 0.5f;
        const Lines lines = lines_to(center, radius, line, source.size, x, middle, load(shift));
        Floats sums[3] = {0.0f, 0.0f, 0.0f};
        source.planes.size() == 1 ? sum_along<1>(lines, line, source, sums) : sum_along<3>(lines, line, source, sums);
        for (size_t p = 0; p < source.planes.size(); ++p) {
            store(sums[p], pixels);
            std::copy_n(pixels, std::min(16, source.size.x - x0), result.row(p, y) + x0);
        }
    }
}

void add_row_kernel(const BlurImage& glow, vec3 color, int y, Image<vec3>& sum, Image<vec3>* part) {
    const vec2 scale = vec2(glow.size) / vec2(sum.size), last = vec2(glow.size) - 0.5f;
    const float down = std::clamp((static_cast<float>(y) + 0.5f) * scale.y, 0.5f, last.y);
    const size_t planes = glow.planes.size();
    alignas(64) float value[3][16];
    for (int x0 = 0; x0 < sum.size.x; x0 += 16) {
        // Clamped at the border, where the blurred image ends half a pixel early.
        const Floats across = min(max(middles(x0, sum.size.x) * scale.x, 0.5f), last.x);
        const Taps taps(across, down, glow.planes[0].size.x);
        for (size_t p = 0; p < planes; ++p) store(taps.of(glow.planes[p]), value[p]);
        const float *red = value[0], *green = planes > 1 ? value[1] : red, *blue = planes > 1 ? value[2] : red;
        for (int i = 0; i < std::min(16, sum.size.x - x0); ++i) {
            const vec3 light = color * vec3(red[i], green[i], blue[i]);
            sum.at(x0 + i, y) += light;
            if (part) part->at(x0 + i, y) += light;
        }
    }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(blur_row_kernel);
HWY_EXPORT(add_row_kernel);

BlurImage blurred(const BlurImage& source, const BlurLine& line, vec2 center, float radius, const View& view) {
    BlurImage result(source.size, source.planes.size());
    parallel_for(source.size.y, [&](int64_t y) {
        HWY_DYNAMIC_DISPATCH(blur_row_kernel)
        (source, line, center, radius, view, static_cast<int>(y), result);
    });
    return result;
}

void add_glow(const BlurImage& glow, vec3 color, Image<vec3>& sum, Image<vec3>* part) {
    parallel_for(sum.size.y, [&](int64_t y) {
        HWY_DYNAMIC_DISPATCH(add_row_kernel)(glow, color, static_cast<int>(y), sum, part);
    });
}
}
#endif
