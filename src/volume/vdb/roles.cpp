#include "volume/vdb/roles.h"

#include "base/text.h"
#include "volume/vdb/file/prewalk.h"

#include <algorithm>
#include <string>

namespace tyndall {
namespace {
struct NamedRole {
    std::string_view name;
    GridRole role;
};
// Grid names of Houdini, Mantaflow, EmberGen and Bifrost, and attribute names that renderers recognize.
constexpr NamedRole named_roles[] = {
    {"temperature", GridRole::temperature},
    {"temp", GridRole::temperature},
    {"heat", GridRole::flame},
    {"flame", GridRole::flame},
    {"flames", GridRole::flame},
    {"fire", GridRole::flame},
    {"burn", GridRole::flame},
    {"fuel", GridRole::other},
    {"color", GridRole::color},
    {"cd", GridRole::color},
    {"emission", GridRole::emission},
    {"shadow", GridRole::other},
    {"vel", GridRole::velocity},
    {"velocity", GridRole::velocity},
    {"v", GridRole::velocity},
    {"pressure", GridRole::other},
    {"rest", GridRole::other},
    {"uvw", GridRole::other},
    {"surface", GridRole::level_set},
    {"sdf", GridRole::level_set},
};
}

GridRole role_of_name(std::string_view name) {
    const std::string lower = lower_case(std::string(name.substr(0, name.find('.'))));
    const auto found = std::ranges::find(named_roles, std::string_view(lower), &NamedRole::name);
    return found == std::end(named_roles) ? GridRole::density : found->role;
}

GridRole role_of(const VdbGridEntry& grid) {
    const GridRole named = role_of_name(grid.name);
    if (is_vector_float(grid)) return named == GridRole::density ? GridRole::other : named;
    if (!is_scalar_float(grid)) return GridRole::other;
    return grid.grid_class == "level set" ? GridRole::level_set : named;
}
}
