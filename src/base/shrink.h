// Downsamples images.
#pragma once
#include "base/image.h"
#include "base/parallel.h"

namespace tyndall {
// Box filter: each pixel is the mean of value(pixel), a vec3, over the pixels of the larger image that it covers.
template<typename Value> Image<vec3> shrunk(const Image<vec3>& image, ivec2 size, Value value) {
    Image<vec3> result(size);
    parallel_for(size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < size.x; ++x) {
            const ivec2 low = ivec2(x, y) * image.size / size;
            const ivec2 high = glm::max((ivec2(x, y) + 1) * image.size / size, low + 1);
            vec3 sum(0);
            for (int j = low.y; j < high.y; ++j)
                for (int i = low.x; i < high.x; ++i) sum += value(image.at(i, j));
            result.at(x, y) = sum / static_cast<float>((high.x - low.x) * (high.y - low.y));
        }
    });
    return result;
}
}
