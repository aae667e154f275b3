// Checks of multiple scattering: conservation of energy and published tables.
#include "measure/verify/rays.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
const Box unit_box{vec3(0), vec3(1)};
const Box slab{vec3(-1e4f, 0, -1e4f), vec3(1e4f, 1, 1e4f)};

void add(Checks& checks, const std::string& name, const RayEstimate& light, double expected) {
    checks.add(name, light.value.x, expected, 3 * light.error.x, "3 standard errors");
}

void check_furnace(Checks& checks) {
    const Ray ray{{0.4f, 0.3f, 3}, glm::normalize(vec3(0.05f, 0.1f, -1))};
    for (const float g : {-0.5f, 0.0f, 0.8f}) {
        Snapshot snapshot =
            snapshot_of({noise_medium(6, forward_phase(g)), homogeneous_medium(0.5f, unit_box)}, {}, vec3(1));
        snapshot.background.color = vec3(1);
        add(checks, "rough fog in even surroundings, g " + std::to_string(g).substr(0, g < 0 ? 4 : 3),
            path_light(snapshot, ray, 4096), 1);
    }
    Scene white;
    white.materials = {lambert(vec3(1))};
    white.meshes = {box_of(vec3(0.2f), vec3(0.6f), 0)}, white.instances = {{-1, 0}};
    Snapshot snapshot = snapshot_of({noise_medium(4, forward_phase(0.6f))}, {}, vec3(1));
    add_surfaces(white, snapshot);
    snapshot.background.color = vec3(1);
    add(checks, "the same with a white box in it", path_light(snapshot, ray, 4096), 1);

    // Walls that emit 1 - base color.
    Scene oven;
    oven.materials = {lambert(vec3(0.6f), vec3(0.4f))};
    oven.meshes = {box_of(vec3(-1), vec3(2), 0)}, oven.instances = {{-1, 0}};
    Snapshot closed = snapshot_of({noise_medium(4, forward_phase(0.5f))}, {});
    add_surfaces(oven, closed);
    add(checks, "rough fog in a glowing oven", path_light(closed, {{0.4f, 0.4f, 1.5f}, {0, 0, -1}}, 4096), 1);
}

// Share of a perpendicular beam that a slab reflects or transmits, measured by reciprocity as the radiance along the
// perpendicular in uniform light from one side. A black floor blocks light from below.
void check_slabs(Checks& checks) {
    const struct {
        const char* source;
        float albedo, g, depth;
        double reflected, transmitted;
    } rows[] = {{"Wang et al. 1995: albedo .9, g .75, depth 2", 0.9f, 0.75f, 2, 0.09739, 0.66096},
                {"van de Hulst 1980: albedo 1, g 0, depth 1", 1, 0, 1, 0.34133, 0.65867},
                {"van de Hulst 1980: albedo .9, g .5, depth 1", 0.9f, 0.5f, 1, 0, 0.73909}};
    Scene floor;
    floor.materials = {lambert(vec3(0))};
    floor.meshes = {floor_of(-2, 1e5f, 0)}, floor.instances = {{-1, 0}};
    for (const auto& row : rows) {
        Snapshot snapshot =
            snapshot_of({homogeneous_medium(row.depth, slab, forward_phase(row.g), vec3(row.albedo))}, {}, vec3(1));
        add_surfaces(floor, snapshot);
        if (row.reflected > 0)
            add(checks, std::string(row.source) + ", reflected",
                path_light(snapshot, {{0.5f, 3, 0.5f}, {0, -1, 0}}, row.reflected < 0.2 ? 45056 : 12288),
                row.reflected);
        snapshot.background.color = vec3(1);
        add(checks, std::string(row.source) + ", transmitted",
            path_light(snapshot, {{0.5f, -1, 0.5f}, {0, 1, 0}}, 6144), row.transmitted);
    }
}

// Van de Hulst 1980, table 12: isotropic, albedo .8, depth 2, seen at cosine ½, over the cosine of the sun.
void check_radiance(Checks& checks) {
    const struct {
        const char* name;
        double mu0, above, below;
    } rows[] = {{"sun overhead", 1, 0.28616, 0.14864},
                {"sun at 45.6°", 0.7, 0.34188, 0.13963},
                {"sun at 72.5°", 0.3, 0.45353, 0.09425}};
    for (const auto& row : rows) {
        const float sine = static_cast<float>(std::sqrt(1 - row.mu0 * row.mu0));
        const Light sun =
            sun_light({sine, -static_cast<float>(row.mu0), 0}, static_cast<float>(static_cast<double>(pi) / row.mu0));
        const Snapshot snapshot = snapshot_of({homogeneous_medium(2, slab, forward_phase(0), vec3(0.8f))}, {sun});
        const vec3 down = glm::normalize(vec3(0, -0.5f, std::sqrt(0.75f)));
        add(checks, std::string("slab lit by the ") + row.name + ", from above",
            path_light(snapshot, {vec3(0, 3, 0), down}, 3072), row.above);
        add(checks, std::string("slab lit by the ") + row.name + ", from below",
            path_light(snapshot, {vec3(0, -2, 0), vec3(0, 0.5f, down.z)}, row.below < 0.1 ? 16384 : 4096), row.below);
    }
}

void check_surfaces(Checks& checks) {
    // Two large plates facing each other: the upper emits 1 and reflects .4, the lower reflects .5.
    Scene plates;
    plates.materials = {lambert(vec3(0.5f)), lambert(vec3(0.4f), vec3(1))};
    plates.meshes = {floor_of(0, 3000, 0), floor_of(1, 3000, 1)}, plates.instances = {{-1, 0}, {-1, 1}};
    Snapshot snapshot = snapshot_of({}, {});
    add_surfaces(plates, snapshot);
    const Ray ray{{0, 0.5f, 0}, {0, -1, 0}};
    add(checks, "two plates, all orders", path_light(snapshot, ray, 4096), 0.5 / (1 - 0.5 * 0.4));
    add(checks, "two plates, three orders", path_light(snapshot, ray, 4096, 3), 0.5 + 0.5 * 0.4 * 0.5);
}
}

std::vector<CheckGroup> transport_checks() {
    return {{"white furnace", 5, check_furnace},
            {"multiple scattering, energy", 12, check_slabs},
            {"multiple scattering, radiance", 8, check_radiance},
            {"surfaces", 2, check_surfaces}};
}
}
