// tyndall info: photometric files.
#include "common.h"
#include "reports.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/json/json_values.h"
#include "base/text.h"
#include "scene/file/scene_file.h"
#include "scene/photometry/ies_file.h"
#include "scene/photometry/ies_profile.h"

namespace tyndall {
namespace {
constexpr char type_letters[] = {'?', 'C', 'B', 'A'};

std::string type_of(const IesFile& file) { return {type_letters[static_cast<int>(file.type)]}; }

std::string span_text(const std::vector<double>& angles, const char* noun) {
    if (angles.size() == 1) return std::string("one ") + noun + ", the same all around";
    return std::to_string(angles.size()) + " " + noun + "s, " + shortest_text(angles.front()) + " to " +
           shortest_text(angles.back()) + " degrees";
}

// Flux and peak intensity, and whether they are absolute or relative to the lamps' rating.
std::string photometry_text(const IesFile& file, double lumens) {
    const std::string sent = formatted("%.4g lumens, peak %.4g candela", lumens, file.peak());
    if (file.absolute()) return sent + ", absolute";
    const double lamps = file.lamps * file.lumens_per_lamp;
    return sent + formatted(", for lamps of %g x %g lumens (%.3g %% leave the luminaire)", file.lamps,
                            file.lumens_per_lamp, lamps > 0 ? 100 * lumens / lamps : 0.0);
}

std::string scene_line(const std::filesystem::path& file) {
    return R"({ "type": "point", "name": "lamp", "position": [0, 3, 0], "direction": [0, -1, 0], "ies": { "file": )" +
           quote_json(file.filename().string()) + " } }";
}

std::string json_text(const std::filesystem::path& path, const IesFile& file, double lumens) {
    std::vector<Json> keywords;
    for (const auto& [name, text] : file.keywords) keywords.push_back(json_object({{"name", name}, {"text", text}}));
    return json_line({{"file", path.native()},
                      {"kind", "ies"},
                      {"standard", file.standard},
                      {"type", type_of(file)},
                      {"vertical_angles", file.vertical.size()},
                      {"vertical_range", std::vector{file.vertical.front(), file.vertical.back()}},
                      {"horizontal_angles", file.horizontal.size()},
                      {"horizontal_range", std::vector{file.horizontal.front(), file.horizontal.back()}},
                      {"lumens", lumens},
                      {"peak_candela", file.peak()},
                      {"absolute", file.absolute()},
                      {"lamps", file.lamps},
                      {"lumens_per_lamp", file.lumens_per_lamp},
                      {"multiplier", file.multiplier},
                      {"ballast_factor", file.ballast},
                      {"tilt", file.tilt},
                      {"watts", file.watts},
                      {"size", std::vector{file.size.x, file.size.y, file.size.z}},
                      {"keywords", Json(keywords)},
                      {"notes", file.notes},
                      {"scene", scene_line(path)}});
}
}

std::string ies_report(const std::filesystem::path& path, bool json) {
    IesFile file = read_ies(read_file(path, largest_ies_file), path.string());
    if (std::string loss = make_ies_profile(file, "")->loss; !loss.empty()) file.notes.push_back(std::move(loss));
    const double lumens = zonal_lumens(file);
    if (json) return json_text(path, file, lumens);
    std::string text =
        printable(path.string()) + ": IES photometry, " + file.standard + ", type " + type_of(file) + "\n";
    text += "  light         " + photometry_text(file, lumens) + "\n";
    text += "  vertical      " + span_text(file.vertical, "angle") + "\n";
    text += "  horizontal    " + span_text(file.horizontal, "plane") + "\n";
    text +=
        formatted("  factors       candela multiplier %g, ballast %g, tilt %s; all but tilt are in the numbers above\n",
                  file.multiplier, file.ballast, printable(file.tilt, 60).c_str());
    text += formatted("  luminaire     %g W, %.3g x %.3g x %.3g m\n", file.watts, std::abs(file.size.x),
                      std::abs(file.size.y), std::abs(file.size.z));
    for (const auto& [name, words] : file.keywords)
        text += "  keyword       " + printable(name, 40) + ": " + printable(words, 120) + "\n";
    for (const std::string& note : file.notes) text += "  note          " + printable(note, 400) + "\n";
    return text + "  in a scene    " + scene_line(path) + "\n";
}
}
