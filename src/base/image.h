// A rectangle of pixels, row by row from the upper left.
#pragma once
#include "base/math.h"

#include <cstddef>
#include <vector>

namespace tyndall {
template<class T> struct Image {
    ivec2 size{0};
    std::vector<T> pixels;

    Image() = default;
    explicit Image(ivec2 size_, T value = T{}) : size(size_), pixels(static_cast<size_t>(size_.x) * size_.y, value) {}
    bool empty() const { return pixels.empty(); }
    T& at(int x, int y) { return pixels[static_cast<size_t>(y) * size.x + x]; }
    const T& at(int x, int y) const { return pixels[static_cast<size_t>(y) * size.x + x]; }
};
}
