#include "measure/metrics/pictures.h"

namespace tyndall::test {
Image<vec3> constant(vec3 color, ivec2 size) { return Image<vec3>(size, color); }

Image<vec3> shaft(ivec2 size, double shift, double ripple) {
    Image<vec3> image(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const double beam = 8 * std::exp(-std::pow((x - shift - 20 - 0.5 * y) / 4, 2));
            const double checker = (x / 8 + y / 8) % 2 ? 0.25 : 0;
            for (int c = 0; c < 3; ++c) {
                const double stripes = 0.3 + 0.2 * (1 + ripple) * std::sin(0.31 * x + 0.17 * y * (c + 1));
                image.at(x, y)[c] = static_cast<float>(stripes + checker * (3 - c) / 3 + beam * (2 + c) / 4);
            }
        }
    return image;
}

Image<vec3> scaled(Image<vec3> image, float factor) {
    for (vec3& color : image.pixels) color *= factor;
    return image;
}
}
