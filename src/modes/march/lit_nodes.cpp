#include "modes/march/lit_nodes.h"

namespace tyndall {
namespace {
// Shadow rays to the light's point, through surfaces with alpha.
void find_alpha_shadows(const Occluders& occluders, const LightPoint& to, std::span<const LitNode> nodes,
                        float* share) {
    Occluders::ShadowRays rays{};
    for (size_t i = 0; i < nodes.size(); ++i) rays.set(i, ray_to_point(to, nodes[i].position));
    occluders.transmission(rays, share);
}
}

// Systematic resampling (Kitagawa 1996).
void LitNodes::add_drawn(std::span<const LitNode> nodes, int wanted, float jitter) {
    const auto weight = [](const LitNode& node) { return node.light.x + node.light.y + node.light.z; };
    double all = 0, before = 0;
    for (const LitNode& node : nodes) all += weight(node);
    const double each = all / wanted, shift = jitter;
    for (const LitNode& node : nodes) {
        const double after = before + weight(node);
        const double times = std::floor(after / each + shift) - std::floor(before / each + shift);
        before = after;
        if (times > 0) add({node.position, node.light * (times * each / weight(node))});
    }
}

void LitNodes::attenuate() {
    if (count == 0) return;
    alignas(64) float x[16] = {}, y[16] = {}, z[16] = {}, depths[16] = {}, share[16];
    alignas(64) int32_t active[16] = {};
    std::fill(std::begin(share), std::end(share), 1.0f);
    for (int i = 0; i < count; ++i) {
        const dvec3& position = pending[i].position;
        x[i] = float(position.x), y[i] = float(position.y), z[i] = float(position.z), active[i] = -1;
    }
    const auto& occluders = shadow_casters(*along.light, frame.snapshot);
    if (occluders && occluders->has_alpha())
        find_alpha_shadows(*occluders, along.point, {pending, static_cast<size_t>(count)}, share);
    light_depths(depth, x, y, z, active, depths);
    for (int i = 0; i < count; ++i) sum += double(share[i]) * std::exp(-double(depths[i])) * pending[i].light;
    work += count * march_work(depth);
    count = 0;
}
}
