// Phase functions of a scene file.
#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"
#include "scene/file/scene_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace tyndall {
namespace {
constexpr uint64_t largest_file = uint64_t{16} << 20; // bytes
constexpr size_t max_numbers = 200000;
constexpr size_t max_coefficients = 10000;
constexpr double hardly_off = 1e-3; // tolerance of an integral: rounding of the values

PhaseKind kind_named(std::string_view name) {
    return static_cast<PhaseKind>(std::ranges::find(phase_kinds, name, &PhaseTraits::name) - phase_kinds);
}

// The numbers of a text file, with spaces or commas between them; # begins a comment.
std::vector<double> numbers_of(const std::string& text, const Field& field) {
    std::vector<double> numbers;
    int line = 1;
    for (const char *at = text.data(), *end = at + text.size(); at != end;) {
        if (*at == '#') {
            at = std::find(at, end, '\n');
        } else if (*at == ' ' || *at == '\t' || *at == '\r' || *at == '\n' || *at == ',') {
            line += *at++ == '\n';
        } else {
            double number = 0;
            const auto [next, error] = std::from_chars(at, end, number);
            if (error != std::errc() || !std::isfinite(number)) {
                const char* word =
                    std::find_if(at, end, [](char c) { return std::isspace(static_cast<unsigned char>(c)); });
                refuse(field, formatted("line %d of its file: expected a number, got ", line) +
                                  quote_json(printable(std::string(at, word), 40)));
            }
            if (numbers.size() == max_numbers)
                refuse(field, formatted("its file holds more than %zu numbers", max_numbers));
            numbers.push_back(number), at = next;
        }
    }
    return numbers;
}

// The numbers under a key of the object, or in the file it names.
std::vector<double> stated_numbers(const Field& field, std::string_view key, Scene& scene) {
    const Field file = field.member("file"), inside = field.member(key);
    if (bool(file) == bool(inside)) refuse(field, "needs either " + quote_json(key) + " or \"file\"");
    std::vector<double> numbers;
    if (file) {
        const std::filesystem::path path = named_file(file, scene);
        std::string text;
        with_location(file, [&] { text = read_file(path, largest_file); });
        add_input(scene, path, text);
        return numbers_of(text, file);
    }
    for (const Json& item : inside.json->items) {
        if (item.kind == Json::Kind::number) numbers.push_back(item.number);
        for (const Json& part : item.items) numbers.push_back(part.number);
    }
    return numbers;
}

// Angles from 0 to 180 degrees, each with its value.
std::vector<PhaseEntry> read_entries(const Field& field, Scene& scene) {
    const std::vector<double> numbers = stated_numbers(field, "values", scene);
    if (numbers.size() % 2 != 0) refuse(field, "needs pairs of an angle and a value");
    if (numbers.size() < 4) refuse(field, "needs at least two angles, 0 and 180 degrees");
    std::vector<PhaseEntry> entries;
    double most = 0;
    for (size_t i = 0; i < numbers.size(); i += 2) {
        const PhaseEntry entry{numbers[i], numbers[i + 1]};
        if (!entries.empty() && !(entry.angle > entries.back().angle))
            refuse(field, formatted("angles must ascend, but %.9g follows %.9g", entry.angle, entries.back().angle));
        if (entry.value < 0) refuse(field, formatted("the value at %.9g degrees is below 0", entry.angle));
        entries.push_back(entry), most = std::max(most, entry.value);
    }
    if (entries.front().angle != 0 || entries.back().angle != 180)
        refuse(field, formatted("angles must go from 0 to 180 degrees, not from %.9g to %.9g", entries.front().angle,
                                entries.back().angle));
    if (!(most > 1e-30 && most < 1e30)) refuse(field, "the largest value must lie between 1e-30 and 1e30");
    return entries;
}

Phase read_table(const Field& field, Scene& scene) {
    PhaseTableNotes notes;
    const std::vector<PhaseEntry> entries = read_entries(field, scene);
    PhaseTable table = make_table(std::span(entries), notes);
    if (!(std::abs(notes.kept - 1) < 0.01))
        refuse(field, "the values vary too fast with the angle; the finest resolution is 0.01 degrees");
    if (std::abs(notes.integral - 1) > hardly_off)
        warn(scene, field.location() +
                        formatted(": its values integrate to %.6g over the sphere, not to 1; they are normalized",
                                  notes.integral));
    return table_phase(PhaseKind::table, std::move(table));
}

Phase read_series(const Field& field, Scene& scene) {
    constexpr double max_negative = 0.01; // of the light
    const std::vector<double> coefficients = stated_numbers(field, "coefficients", scene);
    if (coefficients.empty() || coefficients.size() > max_coefficients)
        refuse(field, formatted("needs 1 to %zu coefficients, not %zu", max_coefficients, coefficients.size()));
    if (!(coefficients[0] > 1e-30 && coefficients[0] < 1e30)) refuse(field, "the first coefficient must be above 0");
    for (size_t l = 1; l < coefficients.size(); ++l)
        if (std::abs(coefficients[l]) > (2.0 * static_cast<double>(l) + 1) * coefficients[0] * (1 + 1e-6))
            refuse(field, formatted("coefficient %zu is %.6g; its magnitude cannot exceed %zu times the first", l,
                                    coefficients[l], 2 * l + 1));
    PhaseTableNotes notes;
    PhaseTable table = make_table(std::span(coefficients), notes);
    if (notes.negative > max_negative)
        refuse(field, formatted("the series is negative at some angles, by %.2g %% of its light: it is truncated too "
                                "early, or its coefficients lack the factor 2 l + 1",
                                100 * notes.negative));
    if (std::abs(notes.integral - 1) > hardly_off)
        warn(scene, field.location() +
                        formatted(": the first coefficient is %.6g, not 1; all are divided by that", notes.integral));
    if (notes.negative > 1e-6)
        warn(scene,
             field.location() +
                 formatted(": the series is negative at some angles, by %.2g %% of its light; it is clamped to 0 there",
                           100 * notes.negative));
    return table_phase(PhaseKind::legendre, std::move(table));
}

PhaseSource read_object(const Field& field, Scene& scene) {
    PhaseSource source;
    source.own_numbers = true;
    source.kind = kind_named(field.member("type").json->string);
    if (const Field g = field.member("g")) source.g = keyed_number(g);
    if (const Field alpha = field.member("alpha")) source.alpha = keyed_number(alpha);
    if (const Field diameter = field.member("droplet_diameter")) source.droplet_diameter = keyed_number(diameter);
    if (const Field weight = field.member("weight")) source.weight = keyed_number(weight);
    if (const Field lobes = field.member("lobes"))
        for (size_t i = 0; i < lobes.json->items.size(); ++i) source.lobes.push_back(read_object(lobes.item(i), scene));
    if (source.kind == PhaseKind::table) source.shape = read_table(field, scene).shape;
    if (source.kind == PhaseKind::legendre) source.shape = read_series(field, scene).shape;
    return source;
}
}

void read_phase(const Field& medium_field, MediumSource& medium, Scene& scene) {
    const Field phase = medium_field.member("phase"), g = medium_field.member("g");
    if (phase && phase.json->kind == Json::Kind::object) {
        if (g) refuse(g, "cannot be given here: phase is an object with its own parameters");
        medium.phase = read_object(phase, scene);
    } else if (phase) {
        medium.phase.kind = kind_named(phase.json->string);
    }
    if (!medium.phase.takes_medium_g()) {
        if (g) refuse(g, "does not apply to the phase function " + quote_json(phase.json->string));
        medium.g = 0.0f;
        return;
    }
    const PhaseTraits& traits = traits_of(medium.phase.kind);
    for (const float value : medium.g.values)
        if (std::abs(value) > traits.max_g)
            refuse(g ? g : phase, std::string(traits.g_error) + (g ? "" : " (g comes from the fog's file)"));
}
}
