// What a technique promises of its pictures, and where it says that it cannot keep it.
#pragma once
#include <string>
#include <string_view>

namespace tyndall {
enum class Accuracy { look, even_fog, single_scattering, multiple_scattering };
// Who shades what lies behind the fog: the renderer; the mode, which then gets whole camera rays, follows them through
// BLEND surfaces and adds surfaces and background itself; or nobody, because the mode works on the finished picture.
enum class Surfaces { shared, own, post };
enum class Severity { info, degraded, wrong };

struct Limit {
    Severity severity = Severity::info;
    std::string where, why;
};

std::string_view name_of(Accuracy accuracy);
std::string_view name_of(Severity severity);
}
