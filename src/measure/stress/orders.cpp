// Multiple scattering: left out, added from a grid of fluence, and blocked by walls.
#include "measure/stress/trial.h"
#include "modes/mode.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall {
namespace {

// In the thickest fog here, more than a tenth of the light has scattered only once.
const std::vector<Excuse> once{{&limitation::single_scattering_only, 0.9}};
const Light noon = sun_light({0.3f, -1, -0.2f}, 10);
const Camera front = camera_from({0, 0, 4}, vec3(0));

Medium white_box(double depth) {
    return homogeneous_medium(static_cast<float>(depth) / 2, {vec3(-1), vec3(1)}, forward_phase(0.3f));
}
StressScene white(double depth) { return stress_scene({white_box(depth)}, {noon}, front); }

StressScene furnace(double depth) {
    StressScene scene = white(depth);
    scene.snapshot.lights.clear(), scene.settings.path.orders = all_orders;
    scene.snapshot.ambient = scene.snapshot.background.color = vec3(1);
    return scene;
}

// How far the mean is from 1, beyond three standard errors.
double furnace_off(Trial& trial) {
    const Layers layers = trial.render();
    double mean = mean_of(layers.color), squares = 0;
    for (const vec3 pixel : layers.color.pixels) squares += (pixel.x - mean) * (pixel.x - mean);
    const double pixels = static_cast<double>(layers.color.pixels.size());
    return std::max(0.0, std::abs(mean - 1) - 3 * std::sqrt(squares / (pixels * (pixels - 1))));
}

// Error of the fog's mean light against all scattering orders.
double orders_off(Trial& trial) {
    StressScene all_light = trial.scene;
    all_light.settings.path.orders = all_orders, all_light.view.pixel_samples = 64;
    FrameOptions options;
    options.cancel = trial.cancel;
    FrameStats stats;
    const Layers truth =
        render_frame(mode_of_all_orders(), all_light.view, all_light.snapshot, all_light.settings, options, stats);
    const Layers layers = is_unbiased(*trial.mode) ? trial.render(all_light) : trial.render();
    return std::abs(mean_of(layers.inscatter) / mean_of(truth.inscatter) - 1);
}

// --- with the grid -----------------------------------------------------------------------------------------------
StressScene with_grid(StressScene scene) {
    scene.settings.fluence.orders = all_orders;
    return scene;
}
StressScene white_with_grid(double depth) { return with_grid(white(depth)); }

StressScene lobe_with_grid(double g) {
    Medium fog = white_box(1);
    fog.optics.phase = forward_phase(static_cast<float>(g));
    return with_grid(stress_scene({fog}, {noon}, front));
}

StressScene dull_with_grid(double albedo) {
    Medium fog = white_box(2);
    fog.optics.albedo = vec3(static_cast<float>(albedo), 0.9f * static_cast<float>(albedo), 0.5f);
    return with_grid(stress_scene({fog}, {noon}, front));
}

StressScene lamp_with_grid(double depth) {
    Light lamp = point_light({0.3f, 0.2f, -0.1f}, 5);
    lamp.radius = 0.05f;
    return with_grid(stress_scene({white_box(depth)}, {lamp}, front));
}

Mesh turned(Mesh mesh, float angle) {
    const mat3 turn(glm::rotate(mat4(1), angle, vec3(0, 0, 1)));
    for (vec3& p : mesh.positions) p = turn * p;
    for (vec3& n : mesh.normals) n = turn * n;
    return mesh;
}

// A floor through the fog, seen from just below it: the sun is above.
StressScene under_floor(float thickness, float angle) {
    const vec3 down(std::sin(angle), -std::cos(angle), 0);
    const Mesh floor = turned(box_of({-4, -thickness, -4}, {4, 0, 4}, 0), angle);
    Material gray;
    gray.base_color = vec3(0.5f);
    return with_grid(stress_scene({homogeneous_medium(0.5f, {vec3(-1), vec3(1)})}, {sun_light({0, -1, 0}, 10)},
                                  look_at((thickness + 0.05f) * down, 2.0f * down, vec3(0, 0, 1), 0.7f), {floor},
                                  {gray}));
}
StressScene under_thin_floor(double thickness) { return under_floor(static_cast<float>(thickness), 0); }
StressScene under_sloping_floor(double degrees) { return under_floor(0.02f, static_cast<float>(degrees) * pi / 180); }
}

std::vector<StressCase> stress_orders() {
    constexpr std::string_view group = "multiple scattering";
    const StressMeasure mean{0.05, "error of the fog's mean light against all orders", orders_off};
    const StressMeasure dark{0.01, "light below / light without a floor", leak};
    return {
        StressCase("white-furnace", group, "white fog in uniform light is invisible", "optical depth", "", {0.5, 2, 8},
                   "path", {}, furnace, {1e-3, "mean minus 1, beyond three standard errors", furnace_off}),
        StressCase("many-orders", group, "white fog gets thick: light scatters more than once", "optical depth", "",
                   {0.05, 0.2, 0.5, 1, 3, 10}, Claim::physical, once, white,
                   {0.15, "error of the fog's mean light against all orders", orders_off}),
        StressCase("added-orders", group, "the same with a grid of multiply scattered light", "optical depth", "",
                   {0.05, 0.2, 0.5, 1, 3, 10}, Claim::fluence, {}, white_with_grid, mean),
        StressCase("added-lobe", group, "fog with a backward to forward lobe, with such a grid", "g", "",
                   {-0.5, 0, 0.5, 0.9}, Claim::fluence, {}, lobe_with_grid, mean),
        StressCase("added-color", group, "colored fog, with such a grid", "albedo", "", {0, 0.3, 0.9, 1},
                   Claim::fluence, {}, dull_with_grid, mean),
        StressCase("added-lamp", group, "a lamp in fog that gets thick, with such a grid", "optical depth", "",
                   {0.2, 1, 3}, Claim::fluence, {}, lamp_with_grid, mean),
        StressCase("below-floor", group, "light scattered above a floor stays there", "thickness", "m",
                   {0.5, 0.1, 0.02, 0.005}, Claim::fluence, {}, under_thin_floor, dark),
        StressCase("below-slope", group, "the same for a floor that slopes across the cells of the grid", "slope",
                   "degrees", {0, 5, 20, 35, 45}, Claim::fluence, {}, under_sloping_floor, dark),
    };
}
}
