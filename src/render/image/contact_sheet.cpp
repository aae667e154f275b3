#include "render/image/contact_sheet.h"

#include "base/shrink.h"
#include "render/image/lettering.h"
#include "render/image/png.h"

namespace tyndall {
namespace {
constexpr int widest_tile = 640, gap = 4;

void put(const Image<glm::u8vec3>& tile, ivec2 corner, Image<glm::u8vec3>& sheet) {
    for (int y = 0; y < tile.size.y; ++y)
        for (int x = 0; x < tile.size.x; ++x) sheet.at(corner.x + x, corner.y + y) = tile.at(x, y);
}
}

Image<glm::u8vec3> contact_sheet(const std::vector<SheetImage>& pictures, const Display& display) {
    if (pictures.empty()) return {};
    const ivec2 whole = pictures[0].color.size;
    const int width = std::min(whole.x, widest_tile);
    const ivec2 tile(width, std::max(1, whole.y * width / whole.x));
    const int scale = width >= widest_tile ? 3 : width >= widest_tile / 2 ? 2 : 1;
    size_t lines = 0;
    for (const SheetImage& picture : pictures) lines = std::max(lines, picture.lines.size());
    const int strip = (static_cast<int>(lines) * letter_height + 2) * scale;
    const int count = static_cast<int>(pictures.size());
    const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
    const int rows = (count + columns - 1) / columns;

    Image<glm::u8vec3> sheet({columns * (tile.x + gap) + gap, rows * (tile.y + strip + gap) + gap}, glm::u8vec3(24));
    for (int i = 0; i < count; ++i) {
        const ivec2 corner = ivec2(i % columns, i / columns) * (tile + ivec2(gap, strip + gap)) + gap;
        const auto same = [](vec3 color) { return color; };
        put(display_codes(shrunk(pictures[i].color, tile, same), display), corner, sheet);
        ivec2 place = corner + ivec2(2 * scale, tile.y + 2 * scale);
        for (const std::string& line : pictures[i].lines) {
            const bool title = &line == pictures[i].lines.data();
            draw_text(sheet, place, scale, line, glm::u8vec3(title ? 235 : 165));
            place.y += letter_height * scale;
        }
    }
    return sheet;
}

void write_contact_sheet(const std::filesystem::path& file, const std::vector<SheetImage>& pictures,
                         const Display& display) {
    write_png(file, contact_sheet(pictures, display), text_of(display));
}
}
