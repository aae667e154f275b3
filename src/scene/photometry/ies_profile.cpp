#include "scene/photometry/ies_profile.h"

#include "scene/photometry/ies_file.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tyndall {
namespace {
constexpr double to_radians = 3.14159265358979323846 / 180;

double smallest_gap(const std::vector<double>& angles) {
    double gap = 360;
    for (size_t i = 1; i < angles.size(); ++i) gap = std::min(gap, angles[i] - angles[i - 1]);
    return gap;
}

// The largest step that all angles are multiples of, if that is no finer than `finest` degrees; else `finest`.
double even_step(const std::vector<double>& angles, double finest) {
    const double gap = smallest_gap(angles);
    for (int parts = 1; gap / parts >= finest * 0.999; ++parts) {
        const double step = gap / parts;
        const bool fits = std::ranges::all_of(angles, [&](double angle) {
            const double steps = (angle - angles.front()) / step;
            return std::abs(steps - std::round(steps)) < 1e-3;
        });
        if (fits) return step;
    }
    return finest;
}

// Rows, columns and their angles, in degrees.
struct Lattice {
    double first = 0, last = 180, row = 0.25, column = 1;
    bool round = false; // rotationally symmetric, with a single column
};

Lattice lattice_of(const IesFile& file) {
    if (file.type != Photometry::type_c) return {0, 90, 0.25, 1, false};
    Lattice lattice{file.vertical.front(), file.vertical.back(), even_step(file.vertical, 0.1), 360,
                    file.horizontal.size() == 1};
    std::vector<double> circle = file.horizontal; // the table covers the full circle from 0
    if (circle.front() > 0) circle.insert(circle.begin(), 0);
    if (circle.back() < 360) circle.push_back(360);
    if (!lattice.round) lattice.column = even_step(circle, 0.5);
    return lattice;
}

dvec3 direction_of(double vertical, double horizontal) {
    const double v = vertical * to_radians, h = horizontal * to_radians;
    return {std::sin(v) * std::cos(h), std::sin(v) * std::sin(h), std::cos(v)};
}

// The angle from the aim beyond which there is no light, degrees.
double reach_of(const IesProfile& profile, const Lattice& lattice) {
    int lit = 0;
    for (int column = 0; column < profile.columns; ++column)
        for (int row = 0; row < profile.rows; ++row)
            if (profile.shares[static_cast<size_t>(column * profile.rows + row)] > 0) lit = std::max(lit, row + 1);
    return std::min(lattice.first + lit * lattice.row, lattice.last);
}
}

std::shared_ptr<const IesProfile> make_ies_profile(const IesFile& file, std::string content) {
    auto profile = std::make_shared<IesProfile>();
    const Lattice lattice = lattice_of(file);
    profile->content = std::move(content);
    profile->peak = file.peak(), profile->lumens = zonal_lumens(file);
    profile->rows = std::max(static_cast<int>(std::lround((lattice.last - lattice.first) / lattice.row)), 1) + 1;
    profile->columns = lattice.round ? 1 : static_cast<int>(std::lround(360 / lattice.column)) + 1;
    const double row = (lattice.last - lattice.first) / (profile->rows - 1);
    const double column = 360.0 / std::max(profile->columns - 1, 1);
    for (int h = 0; h < profile->columns; ++h)
        for (int v = 0; v < profile->rows; ++v) {
            const double vertical = std::min(lattice.first + v * row, lattice.last);
            const double candela = candela_at(file, direction_of(vertical, h * column));
            profile->shares.push_back(static_cast<float>(candela / profile->peak));
        }
    profile->first = static_cast<float>(lattice.first * to_radians);
    profile->last = static_cast<float>(lattice.last * to_radians);
    profile->rows_per_radian = static_cast<float>(1 / (row * to_radians));
    profile->columns_per_radian = static_cast<float>(1 / (column * to_radians));
    profile->reach = static_cast<float>(reach_of(*profile, lattice) * to_radians);
    profile->detail = static_cast<float>(std::max(smallest_gap(file.vertical), 1.0) * to_radians);
    return profile;
}

double profile_factor(const IesProfile& profile, dvec3 direction) {
    constexpr double rounding = 1e-5;
    const double vertical = std::atan2(std::hypot(direction.x, direction.y), direction.z);
    if (vertical < profile.first - rounding || vertical > profile.last + rounding) return 0;
    const double row = std::clamp((vertical - profile.first) * profile.rows_per_radian, 0.0, profile.rows - 1.0);
    const int lower = std::min(static_cast<int>(row), profile.rows - 2);
    const auto in_column = [&](int column) {
        const float* values = profile.shares.data() + static_cast<size_t>(column * profile.rows + lower);
        return std::lerp(double{values[0]}, double{values[1]}, row - lower);
    };
    if (profile.columns == 1) return in_column(0);
    const double turned = std::atan2(direction.y, direction.x);
    const double column = (turned < 0 ? turned + 2 * double{pi} : turned) * profile.columns_per_radian;
    const int before = std::clamp(static_cast<int>(column), 0, profile.columns - 2);
    return std::lerp(in_column(before), in_column(before + 1), std::clamp(column - before, 0.0, 1.0));
}
}
