#include "scene/photometry/ies_profile.h"

#include "base/text.h"
#include "scene/photometry/ies_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace tyndall {
namespace {
constexpr double to_radians = std::numbers::pi / 180;

double smallest_gap(const std::vector<double>& angles) {
    double gap = 360;
    for (size_t i = 1; i < angles.size(); ++i) gap = std::min(gap, angles[i] - angles[i - 1]);
    return gap;
}

// The largest step that all angles are multiples of, if that is no finer than `finest` degrees.
std::optional<double> even_step(const std::vector<double>& angles, double finest) {
    const double gap = smallest_gap(angles);
    for (int parts = 1; gap / parts >= finest * 0.999; ++parts) {
        const double step = gap / parts;
        const bool fits = std::ranges::all_of(angles, [&](double angle) {
            const double steps = (angle - angles.front()) / step;
            return std::abs(steps - std::round(steps)) < 1e-3;
        });
        if (fits) return step;
    }
    return {};
}

// Rows, columns and their angles, in degrees.
struct Lattice {
    double first = 0, last = 180, row = 0.25, column = 1;
    bool round = false; // rotationally symmetric, with a single column

    double row_count() const { return std::max(std::round((last - first) / row), 1.0) + 1; }
    double column_count() const { return round ? 1 : std::round(360 / column) + 1; }
    double entries() const { return row_count() * column_count(); }
};

constexpr double max_rows = 65536, max_entries = 1 << 20; // 256 KB without planes, 4 MB with

// The exact step of some angles, or else one that resolves their smallest gap, of `coarsest` degrees at most.
double step_of(const std::vector<double>& angles, double exact, double coarsest, double times) {
    const double finest = smallest_gap(angles) / 8;
    const auto limited = [&](double step) {
        const double span = angles.back() - angles.front();
        return std::min(std::max(std::min(step, finest) * times, span / max_rows), coarsest);
    };
    return even_step(angles, limited(exact)).value_or(limited(coarsest));
}

// The steps of the file's angles where such a table is not too large, coarser ones otherwise.
Lattice lattice_of_type_c(const IesFile& file) {
    Lattice lattice{file.vertical.front(), file.vertical.back(), 0, 360, file.horizontal.size() == 1};
    std::vector<double> circle = file.horizontal; // the table covers the full circle from 0
    if (circle.front() > 0) circle.insert(circle.begin(), 0);
    if (circle.back() < 360) circle.push_back(360);
    for (double times = 1;; times *= 2) {
        lattice.row = step_of(file.vertical, 0.01, 0.1, times);
        if (!lattice.round) lattice.column = step_of(circle, 0.1, 0.5, times);
        if (lattice.round || lattice.entries() <= max_entries || times > max_rows) return lattice;
    }
}

// The largest angle from the aim at which a file of type A or B has light, degrees.
double lit_reach(const IesFile& file) {
    const size_t rows = file.vertical.size();
    double reach = 0;
    for (size_t h = 0; h < file.horizontal.size(); ++h)
        for (size_t v = 0; v < rows; ++v) {
            bool lit = false; // here or at one of the neighbors, so in a cell that ends here
            for (size_t i = h - (h > 0); i < std::min(h + 2, file.horizontal.size()); ++i)
                for (size_t j = v - (v > 0); j < std::min(v + 2, rows); ++j) lit |= file.candela[i * rows + j] > 0;
            const double cosine = std::cos(file.vertical[v] * to_radians) * std::cos(file.horizontal[h] * to_radians);
            if (lit) reach = std::max(reach, std::acos(std::clamp(cosine, 0.0, 1.0)) / to_radians);
        }
    return reach;
}

// Polar angles about the aim, with cells half as wide as those of the file.
Lattice lattice_of_type_ab(const IesFile& file) {
    const double gap = std::min(smallest_gap(file.vertical), smallest_gap(file.horizontal));
    Lattice lattice{0, std::clamp(lit_reach(file), 0.01, 90.0)};
    const double across = 360 * std::sin(lattice.last * to_radians);
    for (double cell = gap / 2;; cell *= 1.25) {
        lattice.row = std::min({0.25, cell / 2, lattice.last});
        lattice.column = 90 / std::ceil(std::max(90.0, across / cell / 4)); // columns at 0, 90, 180 and 270 degrees
        if (lattice.entries() <= max_entries) return lattice;
    }
}

Lattice lattice_of(const IesFile& file) {
    return file.type == Photometry::type_c ? lattice_of_type_c(file) : lattice_of_type_ab(file);
}

dvec3 direction_of(double vertical, double horizontal) {
    const double v = vertical * to_radians, h = horizontal * to_radians;
    return {std::sin(v) * std::cos(h), std::sin(v) * std::sin(h), std::cos(v)};
}

// The angle from the aim beyond which the table has no light, degrees.
double reach_of(const IesProfile& profile, const Lattice& lattice) {
    int lit = 0;
    for (int column = 0; column < profile.columns; ++column)
        for (int row = 0; row < profile.rows; ++row)
            if (profile.shares[static_cast<size_t>(column * profile.rows + row)] > 0) lit = std::max(lit, row + 1);
    return std::min(lattice.first + lit * lattice.row, lattice.last);
}

// The table as a file, for its lumens: the same rows in every plane.
IesFile table_of(const IesFile& file, const Lattice& lattice) {
    IesFile table;
    const int rows = static_cast<int>(lattice.row_count()), columns = static_cast<int>(lattice.column_count());
    const double row = (lattice.last - lattice.first) / (rows - 1), column = 360.0 / std::max(columns - 1, 1);
    for (int v = 0; v < rows; ++v) table.vertical.push_back(std::min(lattice.first + v * row, lattice.last));
    for (int h = 0; h < columns; ++h) {
        table.horizontal.push_back(h * column);
        for (const double vertical : table.vertical)
            table.candela.push_back(candela_at(file, direction_of(vertical, h * column)));
    }
    return table;
}

// What resampling loses; empty if the peak is that of the file.
std::string loss_of(const IesFile& file, const Lattice& lattice, double peak) {
    constexpr double tolerated = 0.03;
    if (std::abs(peak / file.peak() - 1) <= tolerated) return {};
    const std::string table = formatted("%.2g", lattice.row) + " degrees";
    if (!(peak > 0)) return "its light is narrower than the table's step of " + table + " and lost: the light is black";
    return "its angles are resampled to steps of " + table + ": the peak of " + formatted("%.4g", file.peak()) +
           " candela becomes " + formatted("%.4g", peak) + "; its lumens are kept";
}

// Degrees over which the light may change: the file's smallest step, but at least 1 degree or 1/64 of a narrow beam,
// which limits the nodes along rays through it.
double detail_of(const IesFile& file, double reach) {
    return std::max(smallest_gap(file.vertical), std::min(2 * reach / 64, 1.0));
}
}

std::shared_ptr<const IesProfile> make_ies_profile(const IesFile& file, std::string content) {
    constexpr double rounding = 1e-6;
    auto profile = std::make_shared<IesProfile>();
    const Lattice lattice = lattice_of(file);
    const IesFile table = table_of(file, lattice);
    const double lumens = zonal_lumens(file), kept = zonal_lumens(table);
    const bool scaled = kept > 0 && std::abs(lumens / kept - 1) > rounding; // else exact, but for rounding
    const double scale = scaled ? lumens / kept : 1;
    profile->content = std::move(content), profile->lumens = lumens;
    profile->peak = table.peak() * scale;
    if (!scaled && std::abs(profile->peak / file.peak() - 1) < rounding) profile->peak = file.peak();
    profile->loss = loss_of(file, lattice, profile->peak);
    profile->rows = static_cast<int>(table.vertical.size());
    profile->columns = static_cast<int>(table.horizontal.size());
    for (const double candela : table.candela)
        profile->shares.push_back(static_cast<float>(profile->peak > 0 ? candela * scale / profile->peak : 0));
    const double row = (lattice.last - lattice.first) / (profile->rows - 1);
    const double column = 360.0 / std::max(profile->columns - 1, 1);
    profile->first = static_cast<float>(lattice.first * to_radians);
    profile->last = static_cast<float>(lattice.last * to_radians);
    profile->rows_per_radian = static_cast<float>(1 / (row * to_radians));
    profile->columns_per_radian = static_cast<float>(1 / (column * to_radians));
    profile->reach = static_cast<float>(reach_of(*profile, lattice) * to_radians);
    profile->detail = static_cast<float>(detail_of(file, profile->reach / to_radians) * to_radians);
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
