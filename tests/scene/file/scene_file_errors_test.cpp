// Every mistake in a scene file is answered with the place and the reason.
#include "scene/images.h"
#include "support/gltf_builder.h"
#include "support/load_answer.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

namespace tyndall {
namespace {
struct Mistake {
    const char* fields; // after "tyndall": 1
    const char* pointer;
    const char* reason;
};

const Mistake mistakes[] = {
    // Types, ranges, unknown keys.
    {R"("frame_rate": 0)", "/frame_rate", ""},
    {R"("frame_rate": "24")", "/frame_rate", ""},
    {R"("frames": "1:48")", "/frames", ""},
    {R"("frames": "48-1")", "/frames", "before the first"},
    {R"("frames": "1-10x2")", "/frames", ""},
    {R"("resolution": [640])", "/resolution", ""},
    {R"("resolution": [640, 0])", "/resolution/1", ""},
    {R"("resolution": [640, 1.5])", "/resolution/1", ""},
    {R"("resolution": [640, 3000000000])", "/resolution/1", ""},
    {R"("exposure": 1e39)", "/exposure", ""},
    {R"("exposure": {"keys": []})", "/exposure/keys", ""},
    {R"("exposure": {"keys": [[0, 1], [0, 2]]})", "/exposure/keys/1/0", "increase"},
    {R"("exposure": {"keys": [[1, 1], [0, 2]]})", "/exposure/keys/1/0", "increase"},
    {R"("exposure": {"keys": [[0, 99]]})", "/exposure/keys/0/1", "64"},
    {R"("exposure": {"keys": [[0, 1]], "interpolation": "cubic"})", "/exposure/interpolation", "smooth"},
    {R"("exposur": 1)", "/exposur", "exposure"},
    // Words of other programs.
    {R"("fps": 25)", "/fps", "did you mean \"frame_rate\"?"},
    {R"("media": [{"type": "homogeneous", "anisotropy": 0.5}])", "/media/0/anisotropy", "did you mean \"g\"?"},
    {R"("media": [{"type": "homogeneous", "density": 0.5}])", "/media/0/density", "did you mean \"extinction\"?"},
    {R"("media": [{"type": "vdb", "file": "a.vdb", "sigma_s": 1}])", "/media/0/sigma_s",
     "did you mean \"extinction\" or \"albedo\"?"},
    {R"("media": [{"type": "homogeneous", "absorption": 1}])", "/media/0/absorption",
     "did you mean \"extinction\" or \"albedo\"?"},
    {R"("media": [{"type": "openvdb", "file": "a.vdb"}])", "/media/0/type", "did you mean \"vdb\"?"},
    {R"("lights": [{"type": "directional", "intensity": 1}])", "/lights/0/type", "did you mean \"sun\"?"},
    {R"("lights": [{"type": "point", "power": 100}])", "/lights/0/power", "did you mean \"intensity\"?"},
    {R"("lights": [{"type": "point", "strength": 100}])", "/lights/0/strength", "did you mean \"intensity\"?"},
    {R"("lights": [{"type": "spot", "outerConeAngle": 40}])", "/lights/0/outerConeAngle", "\"outer_cone\""},
    {R"("background": {"hdri": "sky.hdr"})", "/background/hdri", "did you mean \"image\"?"},
    {R"("ambient": [1, 2])", "/ambient", ""},
    {R"("ambient": [1, 2, -1])", "/ambient/2", ""},
    {R"("gltf_lights": false)", "/gltf_lights", "glTF"},
    // Cameras.
    {R"("camera": "nobody")", "/camera", "no camera"},
    {R"("camera": {"position": [0, 0, 0]})", "/camera", "target"},
    {R"("camera": {"position": [0, 0, 0], "target": [0, 0, 0]})", "/camera/target", "direction"},
    {R"("camera": {"position": [0, 0, 1e39], "target": [0, 0, 0]})", "/camera/position", ""},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "up": [0, 0, 0]})", "/camera/up", "length"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "vertical_fov": 180})", "/camera/vertical_fov", "150"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "vertical_fov": 40, "ortho_height": 2})",
     "/camera/ortho_height", "cannot be combined"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "near": 5, "far": 5})", "/camera/far", "near"},
    {R"("cameras": [{"position": [0, 0, 1], "target": [0, 0, 0]}])", "/cameras/0", "name"},
    {R"("cameras": [{"name": "a", "position": [0, 0, 1], "target": [0, 0, 0]}, {"name": "a", "position": [0, 0, 1], "target": [0, 0, 0]}])",
     "/cameras/1/name", "a"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "aperture_radius": -1, "focus_distance": 1})",
     "/camera/aperture_radius", ""},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "aperture_radius": 0.1, "focus_distance": 0})",
     "/camera/focus_distance", ""},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "focus_distance": 1})", "/camera/focus_distance",
     "aperture_radius"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "aperture_radius": 0.1, "aperture_blades": 2})",
     "/camera/aperture_blades", "3"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "aperture_radius": 0.1, "blade_rotation": 2})",
     "/camera/blade_rotation", "aperture_blades"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "ortho_height": 2, "aperture_radius": 0.1})",
     "/camera/aperture_radius", "orthographic"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "shutter": {"open": 0.5, "close": 0.25}})",
     "/camera/shutter", "closes before it opens"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "shutter": {"open": 0.5}})", "/camera/shutter", "close"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "shutter": {"close": 1, "curve": [0, 0, 0]}})",
     "/camera/shutter/curve", "no light"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "shutter": {"close": 1, "curve": [1]}})",
     "/camera/shutter/curve", "at least 2 items"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "shutter": {"close": 1, "curve": [1, -1]}})",
     "/camera/shutter/curve", ""},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "shutter": 0.5})", "/camera/shutter", "object"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "shutter": {"close": 1e39}})", "/camera/shutter/close",
     "100"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "motion_blur": 1})", "/camera/motion_blur", "shutter"},
    {R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "fStop": 2.8})", "/camera/fStop", "aperture_radius"},
    {R"("cameras": [{"name": "Shot", "aperture_radius": 0.1, "focus_distance": 1}])", "/cameras/0", "position"},
    // Lights.
    {R"("lights": [{"type": "spto", "intensity": 1}])", "/lights/0/type", "spot"},
    {R"("lights": [{"type": "point", "position": [0, 0, 0]}])", "/lights/0", "intensity"},
    {R"("lights": [{"name": "lamp", "intensity": 5}])", "/lights/0", "type"},
    {R"("lights": [{"type": "point", "intensity": 1}])", "/lights/0", "position"},
    {R"("lights": [{"type": "sun", "intensity": 1, "position": [0, 0, 0]}])", "/lights/0", "direction"},
    {R"("lights": [{"type": "sun", "intensity": 1, "target": [0, 0, 0]}])", "/lights/0/target", "position"},
    {R"("lights": [{"type": "spot", "intensity": 1, "position": [0, 1, 0], "target": [0, 1, 0]}])", "/lights/0/target",
     "direction"},
    {R"("lights": [{"type": "sun", "intensity": 1, "direction": [0, 0, 0]}])", "/lights/0/direction", "direction"},
    {R"("lights": [{"type": "spot", "intensity": 1, "position": [0, 1, 0], "target": [0, 0, 0], "direction": [0, -1, 0]}])",
     "/lights/0/target", "cannot be combined"},
    {R"("lights": [{"type": "sun", "intensity": -1, "direction": [0, -1, 0]}])", "/lights/0/intensity", ""},
    {R"("lights": [{"type": "sun", "intensity": 1, "direction": [0, -1, 0], "radius": 1}])", "/lights/0/radius", "sun"},
    {R"("lights": [{"type": "point", "intensity": 1, "position": [0, 0, 0], "angle": 1}])", "/lights/0/angle",
     "suns only"},
    {R"("lights": [{"type": "point", "intensity": 1, "position": [0, 0, 0], "inner_cone": 1}])", "/lights/0/inner_cone",
     "spots only"},
    {R"("lights": [{"type": "point", "intensity": 1, "position": [0, 0, 0], "range": 0}])", "/lights/0/range", ""},
    {R"("lights": [{"type": "spot", "intensity": 1, "position": [0, 0, 0], "direction": [0, -1, 0], "inner_cone": 50}])",
     "/lights/0", "inner_cone"},
    {R"("lights": [{"type": "spot", "intensity": 1, "position": [0, 0, 0], "direction": [0, -1, 0], "inner_cone": 20, "outer_cone": {"keys": [[0, 30], [1, 10]]}}])",
     "/lights/0/outer_cone", "moment"},
    {R"("lights": [{"type": "spot", "intensity": 1, "position": [0, 0, 0], "direction": [0, -1, 0], "outer_cone": 0.01}])",
     "/lights/0/outer_cone", "0.05 degrees"},
    {R"("lights": [{"name": "a", "type": "sun", "intensity": 1, "direction": [0, -1, 0]}, {"name": "a", "type": "sun", "intensity": 1, "direction": [0, -1, 0]}])",
     "/lights/1/name", "already"},
    {R"("lights": [{"type": "spot", "intensity": 1, "position": {"keys": [[0, [0, 1, 0]], [1, [1, 1, 0]]], "loop": true}, "target": {"keys": [[0, [0, 0, 0]], [2, [1, 0, 0]]], "loop": true}}])",
     "/lights/0/target", "same time"},
    // Objects and links.
    {R"("objects": [{"name": "bulb", "casts_shadows": false}])", "/objects", "glTF"},
    {R"("objects": [{"name": "bulb"}])", "/objects/0", "casts_shadows"},
    {R"("objects": [{"name": "bulb", "casts_shadow": false}])", "/objects/0", "casts_shadows"},
    {R"("lights": [{"type": "point", "intensity": 1, "position": [0, 0, 0], "shadow_link": {"include": ["a"]}}])",
     "/lights/0/shadow_link/include/0", "no object"},
    {R"("lights": [{"type": "point", "intensity": 1, "position": [0, 0, 0], "light_link": {}}])",
     "/lights/0/light_link", "either"},
    {R"("lights": [{"type": "point", "intensity": 1, "position": [0, 0, 0], "light_link": ["a"]}])",
     "/lights/0/light_link", ""},
    {R"("lights": [{"type": "point", "intensity": 1, "position": [0, 0, 0], "light_link": {"include": ["a"], "exclude": ["b"]}}])",
     "/lights/0/light_link", "either"},
    // Fog.
    {R"("media": [{"extinction": 1}])", "/media/0", "type"},
    {R"("media": [{"type": "smoke"}])", "/media/0/type", "homogeneous"},
    {R"("media": [{"type": "homogeneous"}])", "/media/0", "extinction"},
    {R"("media": [{"type": "height", "extinction": 1}])", "/media/0", "falloff"},
    {R"("media": [{"type": "height", "extinction": 1, "falloff": 0}])", "/media/0/falloff", ""},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "falloff": 2}])", "/media/0/falloff", ""},
    {R"("media": [{"type": "homogeneous", "extinction": -1}])", "/media/0/extinction", ""},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "albedo": 1.5}])", "/media/0/albedo", ""},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "albedo": [1, 1, 1.5]}])", "/media/0/albedo/2", ""},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "g": 1}])", "/media/0/g", "0.99"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": "schlick", "g": 0.8}])", "/media/0/g",
     "henyey_greenstein"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": "isotropic", "g": 0.1}])", "/media/0/g",
     "isotropic"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": "mie"}])", "/media/0/phase", "rayleigh"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "moe"}}])", "/media/0/phase/type",
     "\"mie\""},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "mie"}}])", "/media/0/phase",
     "droplet_diameter"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "mie", "droplet_diameter": 51}}])",
     "/media/0/phase/droplet_diameter", "50"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "mie", "droplet_diameter": 0}}])",
     "/media/0/phase/droplet_diameter", "0"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "mie", "diameter": 20}}])",
     "/media/0/phase/diameter", "droplet_diameter"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "draine", "g": 0.5}}])", "/media/0/phase",
     "alpha"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "draine", "g": 1, "alpha": 1}}])",
     "/media/0/phase/g", "0.99"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "draine", "g": 0.5, "alpha": -1}}])",
     "/media/0/phase/alpha", "0"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "mix", "weight": 0.5, "lobes": [{"type": "rayleigh"}]}}])",
     "/media/0/phase/lobes", "2"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "mix", "weight": 2, "lobes": [{"type": "rayleigh"}, {"type": "isotropic"}]}}])",
     "/media/0/phase/weight", "1"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "mix", "weight": 0.5, "lobes": [{"type": "rayleigh"}, {"type": "table"}]}}])",
     "/media/0/phase/lobes/1/type", "draine"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "table"}}])", "/media/0/phase", "either"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "table", "values": [[0, 1], [180, 1]], "file": "a.txt"}}])",
     "/media/0/phase", "either"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "table", "values": [[0, 1], [90, 1]]}}])",
     "/media/0/phase", "from 0 to 180"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "table", "values": [[0, 1], [90, 1], [90, 2], [180, 1]]}}])",
     "/media/0/phase", "90 follows 90"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "table", "values": [[0, 1], [90, -1], [180, 1]]}}])",
     "/media/0/phase/values/1/1", "0"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "table", "values": [[0, 0], [180, 0]]}}])",
     "/media/0/phase", "largest value"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "table", "values": [[0, 0], [10.00001, 0], [10.00002, 1], [10.00003, 0], [180, 0]]}}])",
     "/media/0/phase", "too fast"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "legendre", "coefficients": []}}])",
     "/media/0/phase/coefficients", "empty"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "legendre", "coefficients": [0, 1]}}])",
     "/media/0/phase", "first coefficient"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "legendre", "coefficients": [1, 3.1]}}])",
     "/media/0/phase", "coefficient 1"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "phase": {"type": "legendre", "coefficients": [1, 2.9, 4.8, 6.5]}}])",
     "/media/0/phase", "2 l + 1"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "g": 0.5, "phase": {"type": "rayleigh"}}])", "/media/0/g",
     "object"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "bounds": {"low": [0, 0, 0], "high": [1, 0, 1]}}])",
     "/media/0/bounds/high/1", "low"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "scale": [1, 0, 1]}])", "/media/0/scale", "0"},
    {R"("media": [{"type": "homogeneous", "extinction": 1, "scale": 1e-30}])", "/media/0/scale", "too small"},
    {R"("media": [{"type": "vdb", "file": "a.vdb", "sequence": {"mode": "bounce"}}])", "/media/0/sequence/mode",
     "ping_pong"},
    {R"("media": [{"type": "vdb", "file": "a.vdb", "sequence": {"offset": 1.5}}])", "/media/0/sequence/offset", ""},
    // What is behind, beam cards.
    {R"("background": {})", "/background", "exactly one"},
    {R"("background": {"color": 1, "sky": {"zenith": 1, "horizon": 1}})", "/background", "exactly one"},
    {R"("background": {"color": 1, "rotation": 5})", "/background/rotation", "image only"},
    {R"("background": {"sky": {"zenith": 1}})", "/background/sky", "horizon"},
    {R"("lights": [{"type": "environment"}])", "/lights/0", "background"},
    {R"("lights": [{"type": "environment", "color": 1, "image": "a.hdr"}])", "/lights/0", "exactly one"},
    {R"("lights": [{"type": "environment", "color": 1, "radius": 2}])", "/lights/0/radius", "environment lights"},
    {R"("lights": [{"type": "environment", "color": 1, "unit": "lux"}])", "/lights/0/unit", "environment lights"},
    {R"("lights": [{"type": "environment", "color": 1, "rotation": 5}])", "/lights/0/rotation", "image only"},
    {R"("lights": [{"type": "environment", "color": 1}, {"type": "environment", "color": 2}])", "/lights/1",
     "only one environment"},
    {R"("lights": [{"type": "environment", "color": 1, "visible": true}], "background": {"color": 1})",
     "/lights/0/visible", "background"},
    {R"("lights": [{"type": "environment", "visible": false}], "background": {"color": 1})", "/lights/0/visible",
     "this one uses the background"},
    {R"("lights": [{"type": "sun", "direction": [0, -1, 0], "intensity": 1, "sky": {"zenith": 1, "horizon": 1}}])",
     "/lights/0/sky", "environments"},
    {R"("lights": [{"type": "hdri", "color": 1}])", "/lights/0/type", "environment"},
    {R"("billboards": [{"light": "nobody", "from": [0, 1, 0], "to": [0, 0, 0]}])", "/billboards/0/light", "no light"},
};

TEST(SceneFileErrors, NameFileFieldAndReason) {
    const TempFolder folder;
    for (const Mistake& mistake : mistakes) {
        SCOPED_TRACE(mistake.fields);
        const LoadResult answer =
            load(folder.put("bad.json", R"({"tyndall": 1, )" + std::string(mistake.fields) + "}"));
        expect_refusal(answer, "bad.json: " + std::string(mistake.pointer));
        // The pointer ends there, or goes on to a part of the field.
        const std::string behind =
            answer.message.substr(answer.message.find(mistake.pointer)).substr(std::string(mistake.pointer).size());
        EXPECT_TRUE(behind.starts_with(": ") || behind.starts_with("/")) << answer.message;
        EXPECT_NE(answer.message.find(mistake.reason), std::string::npos) << answer.message;
    }
}

TEST(SceneFileErrors, TheDocumentAsAWhole) {
    const TempFolder folder;
    const auto refused = [&](const std::string& text, const char* part) {
        SCOPED_TRACE(text.substr(0, 60));
        expect_refusal(load(folder.put("bad.json", text)), part);
    };
    refused("", "bad.json");
    refused("[]", "bad.json");
    refused("{}", "tyndall");
    refused(R"({"tyndall": 2})", "/tyndall");
    refused(R"({"tyndall": 1, "tyndall": 1})", "/tyndall");
    refused(R"({"tyndall": 1,})", "line 1");
    refused(R"({"tyndall": 1, "exposure": NaN})", "line 1");
    refused(R"({"tyndall": 1, "exposure": 1e400})", "bad.json");
    refused("{\"tyndall\": 1, \"description\": \"\xff\"}", "bad.json");
    refused(R"({"tyndall": 1, "media": )" + std::string(100000, '[') + "}", "64");
    refused(R"({"tyndall": 1, "description": ")" + std::string(20000, 'x') + "\"}", "/description");
}

TEST(SceneFileErrors, MissingFilesAreUnreadable) {
    const TempFolder folder;
    for (const auto& [fields, pointer] : std::map<std::string, std::string>{
             {R"("gltf": "none.glb")", "/gltf"},
             {R"("gltf": ".")", "/gltf"},
             {R"("media": [{"type": "noise", "recipe": "none.json"}])", "/media/0/recipe"},
             {R"("media": [{"type": "vdb", "file": "none.vdb"}])", "/media/0/file"},
             {R"("media": [{"type": "vdb", "file": "none.####.vdb"}])", "/media/0/file"},
             {R"("background": {"image": "none.png"})", "/background/image"}}) {
        SCOPED_TRACE(fields);
        const LoadResult answer = load(folder.put("scene.json", R"({"tyndall": 1, )" + fields + "}"));
        expect_refusal(answer, "scene.json: " + pointer, ExitCode::unreadable);
        EXPECT_NE(
            answer.message.find(pointer == "/gltf" && fields.find("none") == std::string::npos ? "directory" : "none"),
            std::string::npos)
            << answer.message;
    }
    expect_refusal(load(folder / "nothing.json"), "nothing.json", ExitCode::unreadable);
    expect_refusal(load(folder / "."), "", ExitCode::unreadable);
}

TEST(SceneFileErrors, APipeIsNotWaitedFor) {
    const TempFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe.png").c_str(), 0600), 0);
    ASSERT_EQ(mkfifo((folder / "pipe.json").c_str(), 0600), 0);
    expect_refusal(load(folder.put("scene.json", R"({"tyndall": 1, "background": {"image": "pipe.png"}})")),
                   "/background/image", ExitCode::unreadable);
    expect_refusal(load(folder / "pipe.json"), "pipe.json", ExitCode::unreadable);
}

TEST(SceneFileErrors, BrokenFilesThatAreNamed) {
    const TempFolder folder;
    folder.put("bad.json", "{");
    folder.put("bad.vdb", "version https://git-lfs.github.com/spec/v1\n");
    folder.put("bad.exr", std::string("\x76\x2f\x31\x01\x02\0\0\0", 8));
    folder.put("huge.png", png_of({20000, 20000}, {}));
    folder.put("fog.vdb", "no volume");
    const auto refused = [&](const char* fields, const char* part) {
        SCOPED_TRACE(fields);
        expect_refusal(load(folder.put("scene.json", R"({"tyndall": 1, )" + std::string(fields) + "}")), part);
    };
    refused(R"("media": [{"type": "noise", "recipe": "bad.json"}])", "bad.json");
    refused(R"("media": [{"type": "vdb", "file": "bad.vdb"}])", "/media/0/file");
    refused(R"("media": [{"type": "vdb", "file": "fog.vdb"}])", "fog.vdb");
    refused(R"("background": {"image": "bad.exr"})", "/background/image");
    refused(R"("background": {"image": "huge.png"})", "16384");
    expect_refusal(load(folder / "fog.vdb"), "fog.vdb");
}

TEST(SceneFileErrors, TheGltfsLightsKeepTheirType) {
    const TempFolder folder;
    GltfBuilder gltf;
    gltf.members["extensions"] = R"({"KHR_lights_punctual":{"lights":[{"type":"point"}]}})";
    gltf.members["nodes"] = R"([{"name":"lamp","extensions":{"KHR_lights_punctual":{"light":0}}}])";
    gltf.members["scenes"] = R"([{"nodes":[0]}])";
    folder.put("room.gltf", gltf.json());
    const auto refused = [&](const char* light, const char* part) {
        const std::string text = R"({"tyndall": 1, "gltf": "room.gltf", "lights": [)" + std::string(light) + "]}";
        expect_refusal(load(folder.put("scene.json", text)), part);
    };
    refused(R"({"name": "lamp", "type": "spot"})", "/lights/0/type");
    refused(R"({"name": "lamp", "outer_cone": 20})", "/lights/0/outer_cone");
    refused(R"({"name": "lamb", "intensity": 20})", "no light of the glTF has the name");
    expect_refusal(load(folder.put("scene.json", R"({"tyndall": 1, "gltf": "room.gltf", "camera": "main"})")),
                   "/camera");
}
}
}
