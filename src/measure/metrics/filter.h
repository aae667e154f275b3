// Separable filters; border pixels are repeated outwards.
#pragma once
#include "base/image.h"
#include "base/parallel.h"

#include <cassert>

namespace tyndall {
// result(x, y) = Σ horizontal[i] · vertical[j] · image(x + i − radius, y + j − radius), in two passes. The kernels have
// 2·radius + 1 weights; weights of vec3 filter each channel separately.
template<class T>
Image<T> filtered(const Image<T>& image, const std::vector<T>& horizontal, const std::vector<T>& vertical) {
    assert(horizontal.size() % 2 == 1 && vertical.size() % 2 == 1);
    const int width = image.size.x, height = image.size.y;
    const int radius_x = static_cast<int>(horizontal.size() / 2), radius_y = static_cast<int>(vertical.size() / 2);
    Image<T> rows(image.size, T(0)), result(image.size, T(0));
    parallel_ranges(height, 8, [&](int64_t begin, int64_t end) {
        std::vector<T> padded(static_cast<size_t>(width + 2 * radius_x));
        for (int y = static_cast<int>(begin); y < end; ++y) {
            for (int x = -radius_x; x < width + radius_x; ++x)
                padded[static_cast<size_t>(x + radius_x)] = image.at(std::clamp(x, 0, width - 1), y);
            T* sum = &rows.at(0, y);
            for (size_t i = 0; i < horizontal.size(); ++i)
                for (int x = 0; x < width; ++x) sum[x] += horizontal[i] * padded[static_cast<size_t>(x) + i];
        }
    });
    parallel_ranges(height, 8, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (size_t j = 0; j < vertical.size(); ++j) {
                const T* row = &rows.at(0, std::clamp(y + static_cast<int>(j) - radius_y, 0, height - 1));
                T* sum = &result.at(0, y);
                for (int x = 0; x < width; ++x) sum[x] += vertical[j] * row[x];
            }
    });
    return result;
}
}
