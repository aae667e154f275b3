// The background of a scene file.
#include "base/io/file.h"
#include "scene/file/scene_file.h"
#include "scene/images/image_file.h"

namespace tyndall {
namespace {
constexpr uint64_t largest_file = uint64_t{1} << 30;

void read_image(const Field& image, Scene& scene, Background& map) {
    const std::filesystem::path path = named_file(image, scene);
    map.kind = BackgroundKind::image;
    const std::string bytes = read_file(path, largest_file);
    add_input(scene, path, bytes);
    std::string note;
    const std::string location = image.location() + ": " + path.filename().string();
    map.image = std::make_shared<Image<vec3>>(decode_image(bytes, location, note));
    if (!note.empty()) scene.warnings.push_back(location + ": " + note);
}

// Fields of image backgrounds only.
void read_projection(const Field& field, Background& background) {
    background.lat_long = field.json->string_or("projection", "plate") == "lat_long";
    if (const Field intensity = field.member("intensity")) background.intensity = keyed_number(intensity);
    if (const Field rotation = field.member("rotation")) background.rotation = keyed_degrees(rotation);
    if (field.member("rotation") && !background.lat_long)
        refuse(field.member("rotation"), "is for the projection \"lat_long\" only");
}
}

void read_map(const Field& field, Scene& scene, Background& map) {
    const Field color = field.member("color"), sky = field.member("sky"), image = field.member("image");
    if (static_cast<bool>(color) + static_cast<bool>(sky) + static_cast<bool>(image) != 1)
        refuse(field, "needs exactly one of color, sky and image");
    if (image) {
        read_image(image, scene, map);
        map.lat_long = true;
    } else if (color) {
        map.color = keyed_color(color);
    } else {
        map.kind = BackgroundKind::sky;
        map.zenith = keyed_color(sky.member("zenith"));
        map.color = keyed_color(sky.member("horizon"));
        map.own_ground = static_cast<bool>(sky.member("ground"));
        map.ground = map.own_ground ? keyed_color(sky.member("ground")) : map.color;
    }
}

void read_background(const Field& root, Scene& scene) {
    const Field field = root.member("background");
    if (!field) return;
    scene.background.stated = true;
    read_map(field, scene, scene.background);
    if (field.member("image")) return read_projection(field, scene.background);
    for (const char* name : {"projection", "intensity", "rotation"})
        if (const Field given = field.member(name)) refuse(given, "is for an image only");
}
}
