// OpenEXR's standard attributes: windows, color space, time and camera.
#include "render/image/exr_header.h"

#include <ImfFramesPerSecond.h>
#include <ImfIntAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

namespace tyndall {
namespace {
// World to OpenEXR's camera space: left-handed, +x right, +y up, +z forward. Imath matrices multiply row vectors.
Imath::M44f world_to_camera(const Camera& camera) {
    const vec3 axes[3] = {camera.right, camera.up, camera.forward};
    Imath::M44f m;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) m[row][column] = axes[column][row];
        m[3][column] = -glm::dot(axes[column], camera.position);
    }
    return m;
}

// Width and height of the image: at distance 1 (perspective) or everywhere (orthographic).
vec2 screen_window(const Camera& camera, ivec2 display) {
    const float height = view_height(camera);
    return {height * static_cast<float>(display.x) / static_cast<float>(display.y), height};
}

// Camera space to NDC: (0,0) is the image's upper left corner, (1,1) its lower right one, after division by w.
Imath::M44f camera_to_ndc(const Camera& camera, ivec2 display) {
    const vec2 window = screen_window(camera, display);
    const bool orthographic = camera.ortho_height > 0;
    const int center = orthographic ? 3 : 2; // the row whose coordinate is 1 or the depth
    Imath::M44f m;
    m[0][0] = 1 / window.x, m[1][1] = -1 / window.y;
    m[center][0] = m[center][1] = 0.5f;
    if (!orthographic) m[2][3] = 1, m[3][3] = 0;
    return m;
}

// SMPTE time of a frame counted from 0, where the rate allows (whole rates up to 30); it wraps after a day.
void add_time_code(Imf::Header& header, int frame, double frame_rate) {
    const int rate = static_cast<int>(std::lround(frame_rate));
    if (rate < 1 || rate > 30) return;
    const int64_t day = int64_t{24} * 3600 * rate;
    const int64_t index = ((frame % day) + day) % day;
    const auto part = [&](int64_t unit, int64_t count) { return static_cast<int>(index / unit % count); };
    Imf::addTimeCode(header,
                     Imf::TimeCode(part(rate * 3600LL, 24), part(rate * 60LL, 60), part(rate, 60), part(1, rate)));
}
}

Imf::Header make_exr_header(const ExrWindow& window, const Provenance& provenance) {
    const Camera& camera = provenance.camera;
    const ivec2 last = window.low + window.size - 1;
    const Imath::Box2i display({0, 0}, {window.display.x - 1, window.display.y - 1});
    const Imath::Box2i data({window.low.x, window.low.y}, {last.x, last.y});
    Imf::Header header(display, data, 1, {0, 0}, screen_window(camera, window.display).x, Imf::INCREASING_Y,
                       Imf::ZIP_COMPRESSION);
    header.zipCompressionLevel() = 4;

    Imf::addChromaticities(header, Imf::Chromaticities()); // Rec.709, D65
    header.insert("colorInteropID", Imf::StringAttribute("lin_rec709_scene"));
    header.insert("software", Imf::StringAttribute("Tyndall " TYNDALL_VERSION));
    Imf::addFramesPerSecond(header, Imf::guessExactFps(provenance.frame_rate));
    add_time_code(header, provenance.frame, provenance.frame_rate);
    header.insert("imageCounter", Imf::IntAttribute(provenance.frame));

    const Imath::M44f to_camera = world_to_camera(camera);
    Imf::addWorldToCamera(header, to_camera);
    Imf::addWorldToNDC(header, to_camera * camera_to_ndc(camera, window.display));
    if (camera.lens && std::isfinite(camera.lens.focus)) Imf::addFocus(header, camera.lens.focus);
    for (const auto& [name, text] : provenance.attributes) header.insert(name, Imf::StringAttribute(text));
    return header;
}
}
