// Sheets of pictures, and the letters on them.
#include "render/image/contact_sheet.h"
#include "render/image/lettering.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
int inked(const Image<glm::u8vec3>& picture) {
    int count = 0;
    for (const glm::u8vec3 pixel : picture.pixels) count += pixel != glm::u8vec3(0);
    return count;
}

TEST(Lettering, DrawsWithinItsWidthAndScales) {
    Image<glm::u8vec3> small({200, 40}), large({400, 80});
    draw_text(small, {0, 0}, 1, "march 0.25 s", glm::u8vec3(255));
    draw_text(large, {0, 0}, 2, "march 0.25 s", glm::u8vec3(255));
    EXPECT_GT(inked(small), 60);
    EXPECT_EQ(inked(large), 4 * inked(small));
    EXPECT_EQ(text_width("march", 2), 2 * text_width("march", 1));
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 200; ++x)
            EXPECT_TRUE(small.at(x, y) == glm::u8vec3(0) || (x < text_width("march 0.25 s", 1) && y < letter_height));
}

TEST(Lettering, LeavesOutWhatDoesNotFit) {
    Image<glm::u8vec3> picture({10, 6});
    draw_text(picture, {-20, -3}, 3, "outside", glm::u8vec3(255));
    draw_text(picture, {5, 3}, 3, std::string("\xff\x01\n tab\t", 8), glm::u8vec3(255));
    Image<glm::u8vec3> odd({200, 20}), marks({200, 20});
    draw_text(odd, {0, 0}, 1, "\xc3\xa9", glm::u8vec3(255));
    draw_text(marks, {0, 0}, 1, "??", glm::u8vec3(255));
    EXPECT_EQ(odd.pixels, marks.pixels);
}

TEST(ContactSheet, PutsPicturesSideBySideInOrder) {
    std::vector<SheetImage> pictures;
    const vec3 colors[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const vec3 color : colors) pictures.push_back({Image<vec3>({80, 40}, color), {"x", "y"}});
    const Image<glm::u8vec3> sheet = contact_sheet(pictures, {0, ViewTransform::srgb});
    const int tile_height = 40 + 2 * letter_height + 2;
    EXPECT_EQ(sheet.size, ivec2(2 * 80 + 3 * 4, 2 * tile_height + 3 * 4));
    const ivec2 middles[] = {{44, 24}, {128, 24}, {44, 24 + tile_height + 4}};
    for (int i = 0; i < 3; ++i) {
        const glm::u8vec3 pixel = sheet.at(middles[i].x, middles[i].y);
        for (int c = 0; c < 3; ++c) EXPECT_EQ(pixel[c] > 200, c == i) << i;
    }
}

TEST(ContactSheet, ShrinksLargePicturesToTheirMean) {
    Image<vec3> checker({1280, 720});
    for (int y = 0; y < 720; ++y)
        for (int x = 0; x < 1280; ++x) checker.at(x, y) = vec3((x + y) % 2 ? 0.4f : 0.0f);
    const Image<glm::u8vec3> sheet = contact_sheet({{checker, {"checker"}}}, {0, ViewTransform::srgb});
    EXPECT_EQ(sheet.size.x, 640 + 8);
    // sRGB code of the linear mean 0.2.
    EXPECT_NEAR(sheet.at(300, 200).x, 255 * (1.055 * std::pow(0.2, 1 / 2.4) - 0.055), 1.1);
}
}
}
