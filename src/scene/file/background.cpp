// What is behind everything.
#include "base/io/file.h"
#include "scene/file/scene_file.h"
#include "scene/image_file.h"

namespace tyndall {
namespace {
constexpr uint64_t largest_file = uint64_t{1} << 30;

void read_image(const Field& field, Background& background, Scene& scene) {
    const Field image = field.member("image");
    const std::filesystem::path path = named_file(image, scene);
    background.kind = BackgroundKind::image;
    const std::string bytes = read_file(path, largest_file);
    add_input(scene, path, bytes);
    background.image = std::make_shared<Image<vec3>>(decode_picture(bytes, image.place()));
    background.lat_long = field.json->string_or("projection", "plate") == "lat_long";
    if (const Field intensity = field.member("intensity")) background.intensity = keyed_number(intensity);
    if (const Field rotation = field.member("rotation")) background.rotation = read_degrees(rotation);
    if (field.member("rotation") && !background.lat_long)
        refuse(field.member("rotation"), "is for the projection \"lat_long\" only");
}
}

void read_background(const Field& root, Scene& scene) {
    const Field field = root.member("background");
    if (!field) return;
    Background& background = scene.background;
    background.stated = true;
    const Field color = field.member("color"), sky = field.member("sky"), image = field.member("image");
    if (static_cast<bool>(color) + static_cast<bool>(sky) + static_cast<bool>(image) != 1)
        refuse(field, "needs exactly one of color, sky and image");
    if (image) return read_image(field, background, scene);
    for (const char* name : {"projection", "intensity", "rotation"})
        if (const Field given = field.member(name)) refuse(given, "is for an image only");

    if (color) {
        background.color = keyed_color(color);
        return;
    }
    background.kind = BackgroundKind::sky;
    background.zenith = keyed_color(sky.member("zenith"));
    background.color = keyed_color(sky.member("horizon"));
    background.own_ground = static_cast<bool>(sky.member("ground"));
    background.ground = background.own_ground ? keyed_color(sky.member("ground")) : background.color;
}
}
